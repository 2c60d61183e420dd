//! Distributed queries: scheduler, executors and client, based on Ballista.
//!
//! A plan names functions without containing them, so every process registers the fleet functions.

use crate::{functions, lost, robots::Robots, store};
use ballista::prelude::{SessionConfigExt, SessionContextExt};
use ballista_core::{registry::BallistaFunctionRegistry, utils::default_session_builder};
use ballista_executor::executor_process::{ExecutorProcessConfig, start_executor_process};
use ballista_scheduler::{
    cluster::BallistaCluster, config::SchedulerConfig, scheduler_process::start_server,
};
use datafusion::{
    error::{DataFusionError, Result},
    execution::SessionStateBuilder,
    prelude::{SessionConfig, SessionContext},
};
use std::{
    net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr},
    path::PathBuf,
    sync::Arc,
};

/// Largest message between processes, bytes: one partition of estimates.
const LARGEST_MESSAGE: u32 = 256 << 20;

/// Silence after which an executor counts as lost, and interval of its heartbeats, s.
const SILENCE_S: u64 = 20;
const SIGN_OF_LIFE_S: u64 = 5;

fn failed(error: impl std::fmt::Display) -> DataFusionError {
    DataFusionError::Execution(error.to_string())
}

/// Setting of the adaptive planner, which is disabled.
///
/// After a lost executor it reruns the previous stage without a place for its results, and the
/// query never ends. It would only help joins of large tables.
const ADAPTIVE_PLANNER: &str = "ballista.planner.adaptive.enabled";

/// Client of a scheduler.
///
/// # Errors
/// An invalid address.
pub async fn client(url: &str, config: SessionConfig) -> Result<SessionContext> {
    let config = config
        .upgrade_for_ballista()
        .with_ballista_grpc_client_max_message_size(LARGEST_MESSAGE as usize)
        .set_bool(ADAPTIVE_PLANNER, false);
    let state = SessionStateBuilder::new()
        .with_config(config)
        .with_runtime_env(store::runtime().build_arc()?)
        .with_default_features()
        .build();
    SessionContext::remote_with_state(url, state).await
}

/// Address of a local server from its own machine; unspecified addresses become localhost.
fn reached(address: SocketAddr) -> SocketAddr {
    let ip = match address.ip() {
        IpAddr::V4(ip) if ip.is_unspecified() => Ipv4Addr::LOCALHOST.into(),
        IpAddr::V6(ip) if ip.is_unspecified() => Ipv6Addr::LOCALHOST.into(),
        ip => ip,
    };
    SocketAddr::new(ip, address.port())
}

/// Runs a scheduler until it is stopped.
///
/// # Errors
/// An address that is not available.
pub async fn scheduler(address: SocketAddr, robots: Robots) -> Result<()> {
    let builder = Arc::new(move |config: SessionConfig| {
        let state = default_session_builder(config)?;
        let mut state = SessionStateBuilder::new_from_existing(state)
            .with_runtime_env(store::runtime().build_arc()?)
            .build();
        functions::register(&mut state, &robots)?;
        Ok(state)
    });
    let config = SchedulerConfig {
        bind_host: address.ip().to_string(),
        bind_port: address.port(),
        override_session_builder: Some(builder),
        grpc_server_max_decoding_message_size: LARGEST_MESSAGE,
        grpc_server_max_encoding_message_size: LARGEST_MESSAGE,
        executor_timeout_seconds: SILENCE_S,
        expire_dead_executor_interval_seconds: SIGN_OF_LIFE_S,
        // The first task that cannot fetch an executor's results ends the query (see `lost`).
        stage_max_failures: 1,
        task_max_failures: 1,
        ..SchedulerConfig::default()
    };
    let cluster = BallistaCluster::new_from_config(&config)
        .await
        .map_err(failed)?;
    let cluster = lost::ending(&cluster, format!("http://{}", reached(address)));
    start_server(cluster, address, Arc::new(config))
        .await
        .map_err(failed)
}

/// Settings of an executor.
#[derive(Debug, Clone)]
pub struct Executor {
    /// Address for data; the next port is for commands.
    pub address: SocketAddr,
    /// Host and port of the scheduler.
    pub scheduler: (String, u16),
    /// Number of concurrent tasks.
    pub tasks: usize,
    /// Folder of intermediate results; a temporary folder if `None`.
    pub folder: Option<PathBuf>,
    /// Memory limit of all tasks, bytes; a fraction of the machine's memory if `None`.
    pub memory: Option<u64>,
}

/// Runs an executor until it is stopped.
///
/// # Errors
/// A scheduler that cannot be reached, or an address that is not available.
pub async fn executor(own: Executor, robots: &Robots) -> Result<()> {
    let mut registry = BallistaFunctionRegistry::default();
    for function in functions::aggregates(robots) {
        registry
            .aggregate_functions
            .insert(function.name().to_owned(), function);
    }
    for function in functions::scalars() {
        registry
            .scalar_functions
            .insert(function.name().to_owned(), function);
    }
    let folder = own.folder.clone();
    let runtime = move |_: &SessionConfig| {
        let runtime = store::runtime();
        let runtime = match &folder {
            Some(folder) => runtime.with_temp_file_path(folder.clone()),
            None => runtime,
        };
        runtime.build_arc()
    };
    let config = ExecutorProcessConfig {
        bind_host: own.address.ip().to_string(),
        port: own.address.port(),
        grpc_port: own.address.port() + 1,
        scheduler_host: own.scheduler.0,
        scheduler_port: own.scheduler.1,
        scheduler_connect_timeout_seconds: 30,
        vcores: own.tasks,
        work_dir: own.folder.map(|folder| folder.display().to_string()),
        memory_pool_size: own.memory,
        grpc_max_decoding_message_size: LARGEST_MESSAGE,
        grpc_max_encoding_message_size: LARGEST_MESSAGE,
        executor_heartbeat_interval_seconds: SIGN_OF_LIFE_S,
        override_runtime_producer: Some(Arc::new(runtime)),
        override_function_registry: Some(Arc::new(registry)),
        ..ExecutorProcessConfig::default()
    };
    start_executor_process(Arc::new(config))
        .await
        .map_err(failed)
}
