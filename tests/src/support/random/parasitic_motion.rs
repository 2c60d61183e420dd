//! Random robots with parasitic motion: legs that block directions, and drives that block none.
//!
//! One to three legs with two joints and a ball joint each block a direction. Drives with three
//! joints and a ball joint are added until there are as many motors as degrees of freedom, or one
//! more. A drive is a universal joint with a slide, a crank with a rod, or a slide with a rod. Legs
//! are placed randomly around the platform, tilted, and start near a feasible pose.

use super::Dice;
use super::skeleton::write;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Description of a seed, with independent coordinates that may not be the best ones.
#[must_use]
pub fn parasitic_motion(seed: u64) -> String {
    let mut dice = Dice::new(seed);
    let blocking = 1 + dice.below(3);
    let drives = 6 - 2 * blocking + usize::from(dice.chance(0.3));
    let independent = match blocking {
        1 => "\"x\", \"z\", \"rx\", \"ry\", \"rz\"",
        2 => "\"x\", \"z\", \"rx\", \"ry\"",
        _ => "\"z\", \"rx\", \"ry\"",
    };
    let height = dice.distance(0.5, 0.7);
    let mut text = format!(
        "name = \"Random\"\ngravity = [1.0, -2.0, -9.0]\n[platform]\nmotion = \"spatial\"\nindependent = [{independent}]\nhome = {{ z = {height:?} }}\n"
    );
    let mut places = String::new();
    let count = blocking + drives;
    let mut order: Vec<usize> = (0..count).collect();
    dice.shuffle(&mut order);
    for (index, at) in order.into_iter().enumerate() {
        let angle = TAU * at as f64 / count as f64 + dice.angle(0.3);
        let leg = Place {
            name: format!("leg{index}"),
            angle,
            base: dice.distance(0.25, 0.4),
            end: dice.distance(0.15, 0.25),
            height,
        };
        leg.write(&mut dice, &mut text, index < blocking);
        write(
            &mut places,
            format_args!("[[place]]\nname = \"leg{index}\"\nshape = \"leg{index}\"\n"),
        );
        let home = leg.home(&mut dice, &mut text, index < blocking);
        write(&mut places, format_args!("home = {{ {home} }}\n"));
        let end = leg.end_point(&mut dice);
        write(
            &mut text,
            format_args!("[leg.leg{index}.end]\ntype = \"point\"\nat = {end:?}\n"),
        );
    }
    text + &places
}

/// Placement of a leg.
struct Place {
    name: String,
    /// Azimuth, rad.
    angle: f64,
    /// Distance of its base from the middle, m.
    base: f64,
    /// Distance of its ball joint on the platform from the middle, m.
    end: f64,
    /// Height of the platform above the base, m.
    height: f64,
}

impl Place {
    /// Writes the leg's base.
    fn write(&self, dice: &mut Dice, text: &mut String, blocks: bool) {
        let (x, y) = (self.base * self.angle.cos(), self.base * self.angle.sin());
        let tilt = if blocks { 0.15 } else { 0.4 };
        let rotation = [dice.angle(tilt), dice.angle(tilt), self.angle];
        write(
            text,
            format_args!(
                "[leg.{}]\nbase = {{ at = [{x:?}, {y:?}, {:?}], rotation = {rotation:?} }}\n",
                self.name,
                dice.length(0.05)
            ),
        );
    }

    /// Writes the leg's joints; returns their start positions.
    fn home(&self, dice: &mut Dice, text: &mut String, blocks: bool) -> String {
        let inward = self.base - self.end;
        let long = inward.hypot(self.height);
        let name = &self.name;
        let mut joint = |what: String| {
            write(text, format_args!("[[leg.{name}.joint]]\n{what}"));
        };
        let motor = "actuated = true\n";
        if !blocks && dice.chance(0.5) {
            let cross = "type = \"revolute\"\nalpha = \"90 deg\"\ntheta = \"q + 90 deg\"\n";
            joint(format!("name = \"a\"\n{cross}"));
            joint(format!("name = \"b\"\n{cross}"));
            joint(format!(
                "name = \"c\"\ntype = \"prismatic\"\nalpha = \"90 deg\"\n{motor}"
            ));
            return format!("c = {long:?}");
        }
        // A rod that can also swing out of the leg's plane blocks nothing.
        let swing = |joint: &mut dyn FnMut(String)| {
            if !blocks {
                joint("name = \"c\"\ntype = \"revolute\"\nalpha = \"90 deg\"\n".to_owned());
            }
        };
        match if blocks {
            dice.below(3)
        } else {
            1 + dice.below(2)
        } {
            0 => {
                joint("name = \"a\"\ntype = \"revolute\"\nalpha = \"90 deg\"\n".to_owned());
                joint(format!(
                    "name = \"b\"\ntype = \"prismatic\"\nalpha = \"-90 deg\"\n{motor}"
                ));
                format!("b = {long:?}")
            }
            1 => {
                let rod = dice.distance(inward.abs() + 0.2, 0.5);
                let turn = -FRAC_PI_2 - (inward / rod).asin();
                joint(format!("name = \"a\"\ntype = \"prismatic\"\n{motor}"));
                joint("name = \"b\"\ntype = \"revolute\"\nalpha = \"-90 deg\"\n".to_owned());
                swing(&mut joint);
                joint(format!("name = \"tip\"\ntype = \"fixed\"\nd = {rod:?}\n"));
                let start = self.height - (rod * rod - inward * inward).sqrt();
                format!("a = {start:?}, b = {turn:?}")
            }
            _ => {
                let (upper, fore) = (dice.distance(0.4, 0.5), dice.distance(0.4, 0.5));
                let cosine = (long * long - upper * upper - fore * fore) / (2.0 * upper * fore);
                let elbow = cosine.clamp(-1.0, 1.0).acos();
                let ahead = (fore * elbow.sin()).atan2(upper + fore * elbow.cos());
                let shoulder = self.height.atan2(-inward) - ahead;
                joint(format!(
                    "name = \"a\"\ntype = \"revolute\"\nalpha = \"90 deg\"\n{motor}"
                ));
                joint(format!(
                    "name = \"b\"\ntype = \"revolute\"\nd = {upper:?}\n"
                ));
                swing(&mut joint);
                joint(format!("name = \"tip\"\ntype = \"fixed\"\nd = {fore:?}\n"));
                format!("a = {shoulder:?}, b = {elbow:?}")
            }
        }
    }

    /// Position of the ball joint on the platform.
    fn end_point(&self, dice: &mut Dice) -> [f64; 3] {
        let (x, y) = (self.end * self.angle.cos(), self.end * self.angle.sin());
        [x, y, dice.length(0.05)]
    }
}
