// The drawing, rotated by mouse, touch or keys.
'use strict';

class Drawing {
  /** @param draw returns a promise of the drawing at two angles, as text */
  constructor(element, draw) {
    this.element = element;
    this.draw = draw;
    this.angles = [0, 0];
    this.from = null;
    this.isBusy = false;
    this.isWanted = false;
    element.addEventListener('pointerdown', event => {
      element.setPointerCapture(event.pointerId);
      element.classList.add('turning');
      this.from = [event.clientX, event.clientY];
    });
    element.addEventListener('pointermove', event => {
      if (!this.from) return;
      this.turn((event.clientX - this.from[0]) / 120, (event.clientY - this.from[1]) / 120);
      this.from = [event.clientX, event.clientY];
    });
    for (const end of ['pointerup', 'pointercancel']) {
      element.addEventListener(end, () => { this.from = null; element.classList.remove('turning'); });
    }
    element.addEventListener('keydown', event => {
      const step = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] }[event.key];
      if (!step) return;
      event.preventDefault();
      this.turn(...step);
    });
  }

  turn(around, over) {
    this.angles = [this.angles[0] + around, this.angles[1] + over];
    this.show();
  }

  straight() {
    this.angles = [0, 0];
    this.show();
  }

  /** Redraws; requests during a drawing are merged. */
  async show() {
    this.isWanted = true;
    if (this.isBusy) return;
    this.isBusy = true;
    try {
      while (this.isWanted) {
        this.isWanted = false;
        this.put(await this.draw(...this.angles));
      }
    } catch (error) {
      if (!(error instanceof Stopped)) throw error;
    } finally {
      this.isBusy = false;
    }
  }

  /** An SVG document as an element of the page; it is parsed as XML, so names stay text. */
  put(text) {
    if (!text) return;
    const parsed = new DOMParser().parseFromString(text, 'image/svg+xml').documentElement;
    if (parsed.nodeName !== 'svg') throw new Error('the drawing is not SVG');
    this.element.setAttribute('aria-label', `${parsed.getAttribute('aria-label')}; arrow keys turn it`);
    this.element.replaceChildren(document.importNode(parsed, true));
  }
}
