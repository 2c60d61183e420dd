//! Prints an exciting trajectory of a DualV-like robot as TOML, for its description:
//! `cargo run --release -p overact-simulation --example exciting_trajectory -- [SEED]`

#[path = "../tests/support/mod.rs"]
mod support;

use overact_simulation::{Search, search};
use support::{Robot, mechanisms::DualV};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let seed = std::env::args().nth(1).map_or(Ok(0), |text| text.parse())?;
    let names = ["ia_1_leg1", "ia_1_leg2", "ia_1_leg3", "ia_1_leg4"];
    let platform = ["m_platform", "mx_platform", "my_platform", "zz_platform"];
    let wanted = Search {
        fundamental_hz: 0.5,
        harmonics: 6,
        amplitude_limits: vec![0.1, 0.1, 0.8],
        parameters: names
            .into_iter()
            .chain(platform)
            .map(String::from)
            .collect(),
        candidates: 4000,
        seed,
        ..Search::default()
    };
    let found = search(&Robot::new(DualV), &wanted, &|_| ())?;
    println!(
        "# condition number {:.1} of {}; worst partition {:.1}",
        1.0 / found.reciprocal_condition,
        found.base_parameters.join(", "),
        found.worst_partition
    );
    print!("{}", found.trajectory.to_toml());
    Ok(())
}
