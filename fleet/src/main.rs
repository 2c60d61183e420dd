//! `overact-fleet`: queries over a fleet, control charts, the page of a fleet, scheduler and executors.

use clap::{Args, Parser, Subcommand};
use datafusion::arrow::{
    array::RecordBatch, csv::WriterBuilder, util::pretty::pretty_format_batches,
};
use overact_fleet::{
    chart::{Rule, charts, outliers},
    power::Plan,
    report,
    robots::Robots,
    session::{Fleet, Options},
    store::Place,
};
use std::{
    io::Write,
    path::{Path, PathBuf},
    process::ExitCode,
    time::{Duration, Instant},
};

/// Parameters of many robots by SQL over their factor files and logs.
#[derive(Debug, Parser)]
#[command(name = "overact-fleet", version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Answer a query over the tables `factors`, `factor_rows` and `logs`
    Sql(Sql),
    /// Write the report of a fleet: drifts and outliers first, then plots of each robot
    Report(Report),
    /// Simulate when drifts of virtual robots are detected
    Power(Power),
    /// Run the scheduler of a cluster
    #[cfg(feature = "distributed")]
    Scheduler(Scheduler),
    /// Run an executor of a cluster
    #[cfg(feature = "distributed")]
    Executor(Executor),
}

/// Where the data is, and who works on it.
#[derive(Debug, Args)]
struct Data {
    /// Folder of factor files, or `s3://BUCKET/PREFIX`
    #[arg(long, value_name = "FOLDER|URL")]
    factors: Option<Place>,
    /// Folder or URL of logs, `serial=…/day=…/….parquet`
    #[arg(long, value_name = "FOLDER|URL")]
    logs: Option<Place>,
    /// Description of robots in the logs (repeat for others)
    #[arg(long = "robot", value_name = "TOML")]
    robots: Vec<PathBuf>,
    /// Scheduler of a cluster, `df://host:50050` [default: this machine]
    #[arg(long, value_name = "URL")]
    scheduler: Option<String>,
    /// Partitions to process in parallel [default: one for each core]
    #[arg(long, default_value_t = 0, hide_default_value = true)]
    partitions: usize,
    /// Megabytes that a query on this machine may take [default: any]
    #[arg(long, default_value_t = 0, hide_default_value = true)]
    memory: usize,
    /// Read all of every file before the query
    #[arg(long)]
    whole: bool,
    /// Seconds that a query may take [default: 3600 of a cluster, any of this machine]
    #[arg(long, value_name = "SECONDS")]
    limit: Option<f64>,
}

/// Default time limit of a cluster's query, s.
const LIMIT_S: f64 = 3600.0;

#[derive(Debug, Args)]
struct Sql {
    /// The query, or a file with it
    query: String,
    #[command(flatten)]
    data: Data,
    /// Write CSV instead of a table
    #[arg(long)]
    csv: bool,
}

#[derive(Debug, Args)]
struct Report {
    #[command(flatten)]
    data: Data,
    /// Parameters to monitor, separated by commas [default: all]
    #[arg(long, value_delimiter = ',')]
    watch: Vec<String>,
    /// Probability of an alarm of a robot without drift
    #[arg(long, default_value_t = 0.01)]
    false_alarms: f64,
    /// Address of the report of a single robot, with `{serial}`
    #[arg(long, value_name = "URL")]
    link: Option<String>,
    /// The page
    #[arg(short, long, value_name = "HTML")]
    output: PathBuf,
}

#[derive(Debug, Args)]
struct Power {
    /// Description with a virtual experiment
    #[arg(value_name = "TOML")]
    robot: PathBuf,
    /// Robots with each drift
    #[arg(long, default_value_t = 200)]
    robots: usize,
    /// Robots without drift, to count false alarms
    #[arg(long, default_value_t = 1000)]
    healthy: usize,
    /// Days, with one run of each robot
    #[arg(long, default_value_t = 30)]
    days: usize,
    /// Drifts of a first moment of mass, separated by commas
    #[arg(long, value_name = "PERCENT", value_delimiter = ',', default_values_t = [0.25, 0.5, 1.0, 2.0, 4.0])]
    moments: Vec<f64>,
    /// Drifts of viscous friction, separated by commas
    #[arg(long, value_name = "PERCENT", value_delimiter = ',', default_values_t = [2.5, 5.0, 10.0, 20.0])]
    frictions: Vec<f64>,
    /// Parameters to monitor, separated by commas [default: all]
    #[arg(long, value_delimiter = ',')]
    watch: Vec<String>,
    /// Probability of an alarm of a robot without drift
    #[arg(long, default_value_t = 0.01)]
    false_alarms: f64,
    /// Seed of all random numbers
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

#[cfg(feature = "distributed")]
#[derive(Debug, Args)]
struct Scheduler {
    /// Address to listen on
    #[arg(long, default_value = "127.0.0.1:50050")]
    bind: std::net::SocketAddr,
    /// Description of robots in the logs (repeat for others)
    #[arg(long = "robot", value_name = "TOML")]
    robots: Vec<PathBuf>,
    /// Level of messages on stderr: `off`, `error`, `warn`, `info`, `debug`
    #[arg(long, value_name = "LEVEL", default_value = "warn")]
    log: log::LevelFilter,
}

#[cfg(feature = "distributed")]
#[derive(Debug, Args)]
struct Executor {
    /// Address to listen on for data; orders use the next port
    #[arg(long, default_value = "127.0.0.1:50060")]
    bind: std::net::SocketAddr,
    /// Host of the scheduler
    #[arg(long, default_value = "127.0.0.1")]
    scheduler_host: String,
    /// Port of the scheduler
    #[arg(long, default_value_t = 50050)]
    scheduler_port: u16,
    /// Parallel tasks
    #[arg(long, default_value_t = 1)]
    tasks: usize,
    /// Folder for data that other executors fetch
    #[arg(long, value_name = "FOLDER")]
    folder: Option<PathBuf>,
    /// Megabytes for all its tasks
    #[arg(long)]
    memory: Option<u64>,
    /// Description of robots in the logs (repeat for others)
    #[arg(long = "robot", value_name = "TOML")]
    robots: Vec<PathBuf>,
    /// Level of messages on stderr: `off`, `error`, `warn`, `info`, `debug`
    #[arg(long, value_name = "LEVEL", default_value = "warn")]
    log: log::LevelFilter,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    // Plans of large queries are deeply nested.
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .enable_all()
        .thread_stack_size(16 << 20)
        .build();
    let done = match runtime {
        Ok(runtime) => runtime.block_on(run(arguments)),
        Err(error) => Err(error.to_string()),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            // A closed stderr is ignored.
            let _ = writeln!(std::io::stderr(), "error: {message}");
            ExitCode::FAILURE
        }
    }
}

async fn run(arguments: Arguments) -> Result<(), String> {
    match arguments.command {
        Command::Sql(own) => sql(own).await,
        Command::Report(own) => page(own).await,
        Command::Power(own) => power(own),
        #[cfg(feature = "distributed")]
        Command::Scheduler(own) => {
            overact_fleet::logging::on_stderr(own.log);
            let robots = Robots::read(&own.robots)?;
            let done = overact_fleet::distributed::scheduler(own.bind, robots).await;
            done.map_err(|error| error.strip_backtrace())
        }
        #[cfg(feature = "distributed")]
        Command::Executor(own) => {
            overact_fleet::logging::on_stderr(own.log);
            let robots = Robots::read(&own.robots)?;
            let executor = overact_fleet::distributed::Executor {
                address: own.bind,
                scheduler: (own.scheduler_host, own.scheduler_port),
                tasks: own.tasks,
                folder: own.folder,
                memory: own.memory.map(|megabytes| megabytes << 20),
            };
            let done = overact_fleet::distributed::executor(executor, &robots).await;
            done.map_err(|error| error.strip_backtrace())
        }
    }
}

async fn open(data: &Data) -> Result<Fleet, String> {
    let usual = data.scheduler.as_ref().map(|_| LIMIT_S);
    let limit = data.limit.or(usual).map(Duration::try_from_secs_f64);
    let options = Options {
        factors: data.factors.clone(),
        logs: data.logs.clone(),
        robots: Robots::read(&data.robots)?,
        scheduler: data.scheduler.clone(),
        partitions: data.partitions,
        memory: data.memory << 20,
        whole: data.whole,
        limit: limit
            .transpose()
            .map_err(|error| format!("--limit is a number of seconds: {error}"))?,
    };
    let fleet = Fleet::open(options).await;
    fleet.map_err(|error| error.strip_backtrace())
}

/// Prints times and ignored files on stderr.
fn tell(fleet: &Fleet, rows: usize, times: [f64; 2]) {
    let mut text = format!(
        "{rows} rows in {:.2} s, files scanned in {:.2} s\n",
        times[1], times[0]
    );
    for own in fleet.left_out() {
        let runs = match own.runs.len() {
            0 => String::new(),
            count => format!(" {count} of its runs:"),
        };
        text.push_str(&format!("left out: {}:{runs} {}\n", own.file, own.why));
    }
    let _ = std::io::stderr().write_all(text.as_bytes());
}

async fn sql(own: Sql) -> Result<(), String> {
    let query = if Path::new(&own.query).is_file() {
        std::fs::read_to_string(&own.query).map_err(|error| error.to_string())?
    } else {
        own.query
    };
    let start = Instant::now();
    let mut fleet = open(&own.data).await?;
    let opened = start.elapsed().as_secs_f64();
    let rows = fleet
        .sql(&query)
        .await
        .map_err(|error| error.strip_backtrace())?;
    let took = start.elapsed().as_secs_f64() - opened;
    let text = if own.csv {
        csv(&rows)?
    } else {
        format!(
            "{}\n",
            pretty_format_batches(&rows).map_err(|error| error.to_string())?
        )
    };
    tell(
        &fleet,
        rows.iter().map(RecordBatch::num_rows).sum(),
        [opened, took],
    );
    print(&text)
}

fn csv(rows: &[RecordBatch]) -> Result<String, String> {
    let mut bytes = Vec::new();
    let mut writer = WriterBuilder::new().with_header(true).build(&mut bytes);
    for batch in rows {
        writer.write(batch).map_err(|error| {
            format!("{error}: a column has several values; separate them in the query")
        })?;
    }
    drop(writer);
    String::from_utf8(bytes).map_err(|error| error.to_string())
}

/// Watched parameters and false alarm rate.
fn rule(watch: Vec<String>, false_alarms: f64) -> Result<Rule, String> {
    if !(false_alarms > 0.0 && false_alarms < 1.0) {
        return Err("--false-alarms is a probability between 0 and 1".to_owned());
    }
    Ok(Rule {
        false_alarms,
        parameters: watch,
        ..Rule::default()
    })
}

fn power(own: Power) -> Result<(), String> {
    let rule = rule(own.watch, own.false_alarms)?;
    let sizes = own.moments.iter().chain(&own.frictions);
    if own.robots == 0 || own.healthy == 0 || own.days < 4 {
        return Err("a trial has robots of both kinds, and at least 4 days".to_owned());
    }
    if sizes
        .clone()
        .any(|size| size.is_nan() || size.abs() >= 100.0)
    {
        return Err("a drift is less than 100 percent".to_owned());
    }
    let robot = overact_robot::Robot::from_toml(&own.robot).map_err(|error| error.to_string())?;
    let plan = Plan {
        robots: own.robots,
        healthy: own.healthy,
        days: own.days,
        seed: own.seed,
        moments: own.moments,
        frictions: own.frictions,
    };
    let start = Instant::now();
    let tell = |fault: overact_simulation::Fault, percent: f64| {
        let seconds = start.elapsed().as_secs();
        let text = format!(
            "{seconds} s: robots with a drift of {} {percent} %\n",
            fault.name()
        );
        let _ = std::io::stderr().write_all(text.as_bytes());
    };
    let found = overact_fleet::power::power(&robot, &plan, &rule, &tell);
    let found = found.map_err(|error| error.to_string())?;
    print(&overact_fleet::power::table(&found))
}

/// Writes to stdout; a closed pipe is not an error.
fn print(text: &str) -> Result<(), String> {
    match std::io::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(error.to_string()),
        _ => Ok(()),
    }
}

async fn page(own: Report) -> Result<(), String> {
    let rule = rule(own.watch, own.false_alarms)?;
    let mut fleet = open(&own.data).await?;
    let days = report::days(&mut fleet)
        .await
        .map_err(|error| error.strip_backtrace())?;
    let charts = charts(&days.points, &rule);
    let outliers = outliers(&charts, report::BEYOND);
    let page = report::Page {
        days: &days,
        charts: &charts,
        outliers: &outliers,
        rule: &rule,
        left_out: fleet.left_out(),
        link: own.link.as_deref(),
    };
    let html = page.html();
    write_whole(&own.output, html.as_bytes())?;
    tell(&fleet, days.points.len(), [0.0, days.seconds]);
    Ok(())
}

/// Writes a file completely or not at all.
fn write_whole(file: &Path, bytes: &[u8]) -> Result<(), String> {
    let told = |error: std::io::Error| format!("{}: {error}", file.display());
    let own = file.with_extension("part");
    let done = std::fs::write(&own, bytes).and_then(|()| std::fs::rename(&own, file));
    done.map_err(|error| {
        // The partial file is useless; a failure to remove it is ignored.
        let _ = std::fs::remove_file(&own);
        told(error)
    })
}
