//! Many machines: a scheduler, executors that know the functions of a fleet, and their client. They are Ballista's own,
//! with the functions registered in each process, since a plan names functions and does not carry them.

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

/// Bytes of a message between processes, at most: a partition of estimates in one piece.
const LARGEST_MESSAGE: u32 = 256 << 20;

/// Seconds after which an executor that is silent counts as dead, and between its signs of life.
const SILENCE_S: u64 = 20;
const SIGN_OF_LIFE_S: u64 = 5;

fn failed(error: impl std::fmt::Display) -> DataFusionError {
    DataFusionError::Execution(error.to_string())
}

/// The planner that changes a query while it runs. Where a task can't fetch what a lost executor had, it runs the stage
/// before again and then has no place for its results: the query never ends. What it saves, in joins of large tables,
/// is not what a fleet is asked for.
const ADAPTIVE_PLANNER: &str = "ballista.planner.adaptive.enabled";

/// The client of a scheduler.
///
/// # Errors
/// An address that is none.
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

/// Where what listens at an address is reached from its own machine: one that listens everywhere listens here, too.
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
/// An address that can't be had.
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
        // The first task that can't fetch what an executor had ends the query, `lost`.
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

/// Where an executor is and how much it does at once.
#[derive(Debug, Clone)]
pub struct Executor {
    /// Where it listens for data; for orders it listens at the next port.
    pub address: SocketAddr,
    /// Host and port of the scheduler.
    pub scheduler: (String, u16),
    /// Tasks at once.
    pub tasks: usize,
    /// Where it puts what other executors fetch; a temporary folder if none.
    pub folder: Option<PathBuf>,
    /// Bytes that its tasks may take together; a part of the machine's memory if none.
    pub memory: Option<u64>,
}

/// Runs an executor until it is stopped.
///
/// # Errors
/// A scheduler that can't be reached, an address that can't be had.
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
