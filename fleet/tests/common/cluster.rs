//! Cluster of a scheduler and three executors in separate processes.

use std::{
    fs,
    net::{TcpListener, TcpStream},
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    time::{Duration, Instant},
};

/// A process that is killed at the end of its test.
pub(crate) struct Process(Child);

impl Drop for Process {
    fn drop(&mut self) {
        // It may already have ended.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn start(arguments: &[&str], environment: &[(&str, String)]) -> Process {
    let mut command = Command::new(env!("CARGO_BIN_EXE_overact-fleet"));
    let child = command
        .args(arguments)
        .envs(environment.iter().map(|(name, value)| (name, value)))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn();
    Process(child.expect("the program"))
}

/// Free port whose successor is also free; `None` if there is none.
fn port() -> Option<u16> {
    for _ in 0..100 {
        let own = TcpListener::bind("127.0.0.1:0").ok()?;
        let port = own.local_addr().ok()?.port();
        if port < u16::MAX && TcpListener::bind(("127.0.0.1", port + 1)).is_ok() {
            return Some(port);
        }
    }
    None
}

/// Waits until a port accepts connections.
fn wait_for(port: u16) {
    let begin = Instant::now();
    while TcpStream::connect(("127.0.0.1", port)).is_err() {
        assert!(begin.elapsed() < PATIENCE, "nothing listens at {port}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// Time limit for any step, also on a busy machine.
pub(crate) const PATIENCE: Duration = Duration::from_secs(120);

pub(crate) struct Cluster {
    pub(crate) url: String,
    executors: Vec<Process>,
    /// Folders of the executors' intermediate results.
    folders: Vec<PathBuf>,
    _scheduler: Process,
}

impl Cluster {
    /// Number of an executor's result files.
    pub(crate) fn results(&self, executor: usize) -> usize {
        let mut folders = vec![self.folders[executor].clone()];
        let mut count = 0;
        while let Some(folder) = folders.pop() {
            let entries = fs::read_dir(folder).into_iter().flatten().flatten();
            for path in entries.map(|entry| entry.path()) {
                count += usize::from(path.extension().is_some_and(|own| own == "arrow"));
                folders.extend(path.is_dir().then_some(path));
            }
        }
        count
    }

    pub(crate) fn kill(&mut self, executor: usize) {
        let own = &mut self.executors[executor].0;
        own.kill()
            .and_then(|()| own.wait())
            .expect("it was running");
    }
}

/// Starts a scheduler and three executors, each with an environment; `None`, with a message,
/// without ports.
pub(crate) fn cluster(
    folder: &Path,
    of_scheduler: &[(&str, String)],
    of_executors: &[(&str, String)],
) -> Option<Cluster> {
    let ports: Option<Vec<u16>> = (0..4).map(|_| port()).collect();
    let Some(ports) = ports else {
        eprintln!("skipped: this machine gives no ports");
        return None;
    };
    let bind = |port: u16| format!("127.0.0.1:{port}");
    let scheduler = start(&["scheduler", "--bind", &bind(ports[0])], of_scheduler);
    wait_for(ports[0]);
    let folders: Vec<PathBuf> = (0..3)
        .map(|own| folder.join(format!("work-{own}")))
        .collect();
    let executors = folders.iter().zip(&ports[1..]).map(|(work, port)| {
        fs::create_dir_all(work).expect("a folder");
        let (work, to) = (work.display().to_string(), ports[0].to_string());
        let arguments = [
            "executor",
            "--bind",
            &bind(*port),
            "--scheduler-port",
            &to,
            "--folder",
            &work,
        ];
        start(&arguments, of_executors)
    });
    let executors = executors.collect();
    ports[1..].iter().for_each(|port| wait_for(*port));
    // They accept connections before they are registered with the scheduler, which does not report
    // it.
    std::thread::sleep(Duration::from_secs(2));
    Some(Cluster {
        url: format!("df://127.0.0.1:{}", ports[0]),
        executors,
        folders,
        _scheduler: scheduler,
    })
}
