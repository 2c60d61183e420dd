//! The report in a browser: figures, layout and contrast at desktop and phone width, in light, dark
//! and print.
//!
//! Every figure must be visible with contents, and no table may overflow. The browser is
//! `OVERACT_CHROMIUM`, or a Chromium or Chrome in the PATH; without one the tests are skipped with
//! a message. The report is shown in a frame of the required width, because a window cannot be as
//! narrow as a phone. Print is tested as a frame with the print rules, and as a PDF, whose text
//! `pdftotext` reads if installed.

mod common;

use common::{Bench, list, number, robot};
use serde_json::Value;
use std::{
    env, fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};

/// Figures of the report of an overactuated virtual robot, each with words of its plots or
/// description.
const FIGURES: [(&str, &[&str]); 13] = [
    ("figure-robot", &[]),
    ("figure-parameters", &["estimate"]),
    ("figure-elimination-platform", &["relative error"]),
    ("figure-elimination-actuators", &["relative error"]),
    ("figure-conditioning", &["condition"]),
    ("figure-inputs-platform-1", &["measured", "predicted"]),
    ("figure-inputs-actuators-1", &["measured", "predicted"]),
    ("figure-torques-1", &["measured", "predicted"]),
    ("figure-torques-2", &["measured", "predicted"]),
    ("figure-trajectories", &["phi"]),
    ("figure-residuals-platform", &["autocorrelation", "spectr"]),
    ("figure-residuals-actuators", &["autocorrelation", "spectr"]),
    ("tracking", &["computed torque"]),
];

/// Measures the rendered page and reports to the enclosing window.
const PROBE: &str = r#"<script>
addEventListener('load', () => {
  const rgb = text => { const m = text.match(/[\d.]+/g).map(Number); return m.length < 4 || m[3] > 0 ? m : null; };
  const light = c => { const l = c.slice(0, 3).map(v => { v /= 255; return v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4; }); return 0.2126 * l[0] + 0.7152 * l[1] + 0.0722 * l[2]; };
  const behind = e => { for (; e; e = e.parentElement) { const c = rgb(getComputedStyle(e).backgroundColor); if (c) return c; } return [255, 255, 255]; };
  const contrast = (e, colour) => { const a = light(rgb(colour)), b = light(behind(e)); return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05); };
  const texts = [...document.querySelectorAll('h1,h2,h3,p,li,td,th,dt,dd,figcaption,caption,summary,a')].filter(e => e.getClientRects().length && e.textContent.trim());
  const marks = [...document.querySelectorAll('.plot text')];
  const lines = [...document.querySelectorAll('.plot .line path')];
  const least = (all, colour) => all.reduce((found, e) => { const c = contrast(e, getComputedStyle(e)[colour]); return c < found[0] ? [c, e.textContent.trim().slice(0, 60)] : found; }, [99, '']);
  const figures = {};
  for (const e of document.querySelectorAll('figure[id], section[id]')) {
    const box = e.getBoundingClientRect();
    const plots = [...e.querySelectorAll('svg.plot, img')].map(p => { const b = p.getBoundingClientRect();
      return { width: b.width, height: b.height, left: b.left, right: b.right,
        drawn: p.tagName == 'IMG' ? p.naturalWidth : [...p.querySelectorAll('.line path, .line circle, .bar path')].length }; });
    figures[e.id] = { width: box.width, height: box.height, right: box.right, plots, text: e.textContent.toLowerCase() };
  }
  const cut = [...document.querySelectorAll('.scroll')].filter(e => e.scrollWidth > e.clientWidth + 1).map(e => e.scrollWidth - e.clientWidth + ' px of ' + e.getAttribute('aria-label'));
  const wide = [...document.querySelectorAll('body *')].filter(e => !e.closest('svg, thead') && e.getBoundingClientRect().right > innerWidth + 1).map(e => e.tagName + '.' + e.className + ' ' + e.textContent.trim().slice(0, 40));
  parent.postMessage({ width: innerWidth, dark: matchMedia('(prefers-color-scheme: dark)').matches,
    overflow: document.documentElement.scrollWidth - innerWidth, wide: wide.slice(0, 5), cut, figures,
    text: least(texts, 'color'), marks: least(marks, 'fill'), lines: least(lines, 'stroke') }, '*');
});
</script></body>"#;

/// A browser, or `None` with a message.
///
/// The default tier omits it: a browser takes more processor time than all other tests of the
/// command.
fn browser() -> Option<PathBuf> {
    if !overact_tier::is_full() {
        println!("skipped: the full tier looks at the report in a browser");
        return None;
    }
    if let Some(path) = env::var_os("OVERACT_CHROMIUM") {
        return Some(path.into());
    }
    let folders = env::var_os("PATH").unwrap_or_default();
    let names = ["chromium", "chromium-browser", "google-chrome", "chrome"];
    let found = env::split_paths(&folders)
        .flat_map(|folder| names.map(|name| folder.join(name)))
        .find(|path| path.is_file());
    if found.is_none() {
        println!(
            "skipped: no browser; set OVERACT_CHROMIUM to a Chromium to test the report in it"
        );
    }
    found
}

/// Width of an A4 sheet between margins of 12 mm, in pixels of 1/96 inch.
const PAPER: u32 = 703;

/// Runs the browser on a file of the bench.
fn browse(browser: &Path, bench: &Bench, file: &str, tasks: &[String]) -> Output {
    Command::new(browser)
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-quic",
            "--no-first-run",
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
            "--hide-scrollbars",
            "--allow-file-access-from-files",
            "--virtual-time-budget=20000",
        ])
        .arg(format!(
            "--user-data-dir={}",
            bench.path("profile").display()
        ))
        .args(tasks)
        .arg(format!("file://{}", bench.path(file).display()))
        .output()
        .expect("the browser")
}

/// The browser's view of a page at a width and in a colour scheme, as reported by the probe.
///
/// With `OVERACT_SCREENSHOTS`, the view is saved in that folder.
fn view(browser: &Path, bench: &Bench, page: &str, width: u32, dark: bool) -> Value {
    bench.write("probed.html", &page.replace("</body>", PROBE));
    let frame = format!(
        "<!DOCTYPE html><html><body style=\"margin:0\"><pre id=\"told\" hidden></pre>\
         <iframe src=\"probed.html\" style=\"border:0;width:{width}px;height:9000px\"></iframe>\
         <script>addEventListener('message', e => document.getElementById('told').textContent = JSON.stringify(e.data));</script>\
         </body></html>"
    );
    bench.write("frame.html", &frame);
    let run = |task: String| {
        let tasks = [
            // 0 is dark and 1 is light.
            format!("--blink-settings=preferredColorScheme={}", u8::from(!dark)),
            format!("--window-size={},9000", width.max(600)),
            task,
        ];
        browse(browser, bench, "frame.html", &tasks)
    };
    if let Some(folder) = env::var_os("OVERACT_SCREENSHOTS") {
        let scheme = if dark { "dark" } else { "light" };
        let file = Path::new(&folder).join(format!("{width}-{scheme}.png"));
        run(format!("--screenshot={}", file.display()));
    }
    let output = run("--dump-dom".to_owned());
    let dom = String::from_utf8_lossy(&output.stdout).into_owned();
    let shown_output = dom.split_once("hidden=\"\">").map(|(_, rest)| rest);
    let shown_output = shown_output.and_then(|rest| rest.split_once("</pre>"));
    let (shown_output, _) = shown_output.unwrap_or_else(|| {
        panic!(
            "no page from {}: {}",
            browser.display(),
            String::from_utf8_lossy(&output.stderr)
        )
    });
    let text = shown_output
        .replace("&lt;", "<")
        .replace("&gt;", ">")
        .replace("&nbsp;", "\u{a0}")
        .replace("&amp;", "&");
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error} in `{text}`"))
}

/// A bench with the report of a short virtual experiment of the DualV and published results.
fn reported() -> (Bench, String) {
    let bench = Bench::new();
    let text = fs::read_to_string(robot("dualv.toml")).expect("the description");
    bench.write(
        "my.toml",
        &text.replace("duration = \"10 s\"", "duration = \"1.5 s\""),
    );
    let published = robot("published/dualv.toml");
    bench.good(&[
        "identify",
        "my.toml",
        "--published",
        &published,
        "--report",
        "report.html",
        "--report",
        "report.json",
    ]);
    let page = bench.read("report.html");
    (bench, page)
}

/// Nothing is wider than the page, no table is clipped, and texts and lines have contrast.
fn assert_readable(place: &str, seen: &Value) {
    let overflow = number(&seen["overflow"]);
    assert!(overflow <= 0.0, "{place}: {overflow} px: {}", seen["wide"]);
    assert_eq!(list(&seen["wide"]), [Value::Null; 0], "{place}");
    assert_eq!(list(&seen["cut"]), [Value::Null; 0], "{place}");
    for (what, least) in [("text", 4.5), ("marks", 4.5), ("lines", 3.0)] {
        let found = list(&seen[what]);
        assert!(number(&found[0]) >= least, "{place}: {what}: {found:?}");
    }
}

#[test]
fn report_figures_fit_all_widths_and_both_colour_schemes() {
    let Some(browser) = browser() else {
        return;
    };
    let (bench, page) = reported();
    for (width, dark) in [(1280, false), (1280, true), (390, false), (390, true)] {
        let seen = view(&browser, &bench, &page, width, dark);
        let place = format!("{width} px, {}", if dark { "dark" } else { "light" });
        assert_eq!(seen["width"], width, "{place}");
        assert_eq!(seen["dark"], dark, "{place}");
        assert_readable(&place, &seen);
        for (id, words) in FIGURES {
            let figure = &seen["figures"][id];
            assert!(figure.is_object(), "{place}: {id} is missing");
            assert_figure(&format!("{place}: {id}"), figure, words, f64::from(width));
        }
    }
}

#[test]
fn the_printed_report_shows_all_columns_and_collapsed_sections() {
    let Some(browser) = browser() else {
        return;
    };
    let (bench, page) = reported();
    let printed = page
        .replace("@media screen", "@media speech")
        .replace("@media print", "@media all");
    assert_ne!(printed, page);
    assert_readable("paper", &view(&browser, &bench, &printed, PAPER, true));

    let file = bench.path("report.pdf");
    let task = format!("--print-to-pdf={}", file.display());
    browse(
        &browser,
        &bench,
        "report.html",
        &[task, "--no-pdf-header-footer".to_owned()],
    );
    let read = Command::new("pdftotext")
        .arg("-layout")
        .arg(&file)
        .arg("-")
        .output();
    let Ok(read) = read else {
        println!("skipped: no pdftotext to read the printed report with");
        return;
    };
    let text = String::from_utf8_lossy(&read.stdout).replace('\u{a0}', " ");
    for title in [
        "Platform projection",
        "Actuator projection",
        "95 % interval",
        "published",
        "difference",
    ] {
        assert!(text.contains(title), "`{title}` is not in {text}");
    }
    // All base parameters, which are collapsed on the screen, with both of their intervals.
    let document: Value = serde_json::from_str(&bench.read("report.json")).expect("a document");
    let mut estimates = list(&document["estimates"]).iter();
    let base = estimates.find(|one| one["model"] == "actuators" && one["stage"] == "base");
    for parameter in list(&base.expect("case 2")["parameters"]) {
        let name = parameter["name"].as_str().expect("a name");
        let mut lines = text.lines();
        let whole = |line: &&str| {
            let mut words = line.split_whitespace();
            words.next() == Some(name) && line.matches('…').count() == 2
        };
        assert!(lines.any(|line| whole(&line)), "{name} in {text}");
    }
}

/// A figure has a size, non-empty plots within the page, and its words.
fn assert_figure(place: &str, figure: &Value, words: &[&str], width: f64) {
    assert!(number(&figure["width"]) > 200.0, "{place}");
    assert!(number(&figure["height"]) > 60.0, "{place}");
    assert!(number(&figure["right"]) <= width + 1.0, "{place}");
    for plot in list(&figure["plots"]) {
        assert!(number(&plot["width"]) > 150.0, "{place}: {plot}");
        assert!(number(&plot["height"]) > 80.0, "{place}: {plot}");
        assert!(number(&plot["left"]) >= 0.0, "{place}: {plot}");
        assert!(number(&plot["right"]) <= width + 1.0, "{place}: {plot}");
        assert!(number(&plot["drawn"]) >= 1.0, "{place}: {plot}");
    }
    let text = figure["text"].as_str().expect("a text");
    for word in words {
        assert!(text.contains(word), "{place}: `{word}` is not in {text}");
    }
    let is_figure = !place.ends_with("tracking");
    assert!(
        !is_figure || !list(&figure["plots"]).is_empty(),
        "{place}: nothing is drawn"
    );
}
