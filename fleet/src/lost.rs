//! Ends all running queries if an executor is lost; clients then repeat them.
//!
//! The engine would instead rerun the tasks whose results are gone. If an executor is killed
//! between two stages, this duplicates or loses rows. A new task does not always cover the same
//! part of the data as the old one. A repeated query runs completely.

use ballista_core::{
    JobId,
    error::Result,
    serde::{
        protobuf::{
            CancelJobParams, ExecutorHeartbeat, job_status,
            scheduler_grpc_client::SchedulerGrpcClient,
        },
        scheduler::{ExecutorData, ExecutorMetadata},
    },
};
use ballista_scheduler::{
    cluster::{
        BallistaCluster, BoundTask, ClusterState, ClusterStateEventStream, ExecutorSlot, JobState,
    },
    config::TaskDistributionPolicy,
    state::task_manager::JobInfoCache,
};
use std::{
    collections::{HashMap, HashSet},
    sync::Arc,
};

/// The engine's cluster state, except for the reaction to lost executors.
struct Executors {
    engine: Arc<dyn ClusterState>,
    jobs: Arc<dyn JobState>,
    /// Address of this scheduler, `http://host:port`.
    scheduler: String,
}

/// Cluster that ends its queries when an executor is lost.
pub(crate) fn ending(cluster: &BallistaCluster, scheduler: String) -> BallistaCluster {
    let executors = Executors {
        engine: cluster.cluster_state(),
        jobs: cluster.job_state(),
        scheduler,
    };
    BallistaCluster::new(Arc::new(executors), cluster.job_state())
}

impl Executors {
    /// Ends all running queries.
    ///
    /// The scheduler processes events in order, so this one precedes the recovery from the loss.
    async fn end_all(&self) -> Result<()> {
        for job in self.jobs.get_all_jobs().await? {
            let status = self.jobs.get_job_status(&job).await?;
            let running = status.and_then(|own| own.status);
            if !matches!(running, Some(job_status::Status::Running(_))) {
                continue;
            }
            let job_id = job.into_inner();
            log::warn!("query {job_id} ends, for an executor was lost");
            let mut scheduler = SchedulerGrpcClient::connect(self.scheduler.clone()).await?;
            scheduler.cancel_job(CancelJobParams { job_id }).await?;
        }
        Ok(())
    }
}

#[async_trait::async_trait]
impl ClusterState for Executors {
    async fn init(&self) -> Result<()> {
        self.engine.init().await
    }

    async fn bind_schedulable_tasks(
        &self,
        distribution: TaskDistributionPolicy,
        active_jobs: Arc<HashMap<JobId, JobInfoCache>>,
        executors: Option<HashSet<String>>,
    ) -> Result<Vec<BoundTask>> {
        let engine = &self.engine;
        engine
            .bind_schedulable_tasks(distribution, active_jobs, executors)
            .await
    }

    async fn unbind_tasks(&self, executor_slots: Vec<ExecutorSlot>) -> Result<()> {
        self.engine.unbind_tasks(executor_slots).await
    }

    async fn register_executor(
        &self,
        metadata: ExecutorMetadata,
        spec: ExecutorData,
    ) -> Result<()> {
        self.engine.register_executor(metadata, spec).await
    }

    async fn save_executor_metadata(&self, metadata: ExecutorMetadata) -> Result<()> {
        self.engine.save_executor_metadata(metadata).await
    }

    async fn get_executor_metadata(&self, executor_id: &str) -> Result<ExecutorMetadata> {
        self.engine.get_executor_metadata(executor_id).await
    }

    async fn registered_executor_metadata(&self) -> Vec<ExecutorMetadata> {
        self.engine.registered_executor_metadata().await
    }

    async fn save_executor_heartbeat(&self, heartbeat: ExecutorHeartbeat) -> Result<()> {
        self.engine.save_executor_heartbeat(heartbeat).await
    }

    async fn remove_executor(&self, executor_id: &str) -> Result<()> {
        let done = self.engine.remove_executor(executor_id).await;
        self.end_all().await?;
        done
    }

    fn executor_heartbeats(&self) -> HashMap<String, ExecutorHeartbeat> {
        self.engine.executor_heartbeats()
    }

    fn get_executor_heartbeat(&self, executor_id: &str) -> Option<ExecutorHeartbeat> {
        self.engine.get_executor_heartbeat(executor_id)
    }

    async fn cluster_state_events(&self) -> Result<ClusterStateEventStream> {
        self.engine.cluster_state_events().await
    }
}
