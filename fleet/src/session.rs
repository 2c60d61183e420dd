//! A query over the factor files and logs of a fleet, on this machine or by a scheduler on many.
//!
//! - `factor_rows`: the files as they are, without those that can't be read;
//! - `factors`: of them the rows with factors, each run once: its first file counts;
//! - `logs`: the rows of all logs, with the columns `serial` and `day` of the names of their folders.

use crate::{
    catalog::{Catalog, LeftOut, parquet_files, text},
    functions,
    robots::Robots,
};
use arrow::{datatypes::DataType, record_batch::RecordBatch};
use datafusion::{
    datasource::{
        file_format::parquet::ParquetFormat,
        listing::{ListingOptions, ListingTable, ListingTableConfig, ListingTableUrl},
    },
    error::{DataFusionError, Result},
    execution::{memory_pool::FairSpillPool, runtime_env::RuntimeEnvBuilder},
    logical_expr::{col, lit},
    prelude::{DataFrame, SessionConfig, SessionContext},
};
use std::{
    path::{Path, PathBuf},
    sync::Arc,
    time::Duration,
};
use tempfile::TempDir;

/// What a fleet is.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// Folder of factor files.
    pub factors: Option<PathBuf>,
    /// Folder of logs, `serial=…/day=…/….parquet`.
    pub logs: Option<PathBuf>,
    /// Descriptions for `factor`.
    pub robots: Robots,
    /// The scheduler of a cluster, `df://host:port`; none for this machine.
    pub scheduler: Option<String>,
    /// Partitions that are worked on at once; as many as there are cores if 0.
    pub partitions: usize,
    /// Bytes that a query may take on this machine; any number if 0.
    pub memory: usize,
    /// Read all of every file before the first query, and not only after one has failed.
    pub whole: bool,
    /// How long a query may take; as long as it takes if none.
    pub limit: Option<Duration>,
}

/// How often a cluster is asked a query while executors are lost: the scheduler ends a query then. An executor that is
/// killed may end two, one that can't fetch from it and one that is to begin with it.
const ATTEMPTS: usize = 5;

/// Time between two attempts.
const PAUSE: Duration = Duration::from_millis(500);

/// What the engine says of executors that are not there, in errors that carry nothing but a text.
const LOST: [&str; 7] = [
    "failed: Cancelled",
    "has failed 1 times",
    "GrpcConnectionError",
    "Shuffle fetch partition error",
    "executors were lost",
    "transport error",
    "h2 protocol error",
];

/// What is said of a query that takes too long.
const LATE: &str = "the query did not end within";

fn lost(error: &DataFusionError) -> bool {
    let text = error.to_string();
    LOST.iter().any(|own| text.contains(own))
}

/// A fleet that is asked.
pub struct Fleet {
    options: Options,
    context: SessionContext,
    left_out: Vec<LeftOut>,
    /// Links to those logs that can be read, where some can't.
    links: Option<TempDir>,
}

impl Fleet {
    /// Looks through the files and makes them known.
    ///
    /// # Errors
    /// A folder or a scheduler that can't be reached; no file that can be read.
    pub async fn open(options: Options) -> Result<Self> {
        let context = context(&options).await?;
        let mut fleet = Self {
            options,
            context,
            left_out: Vec::new(),
            links: None,
        };
        fleet.register(fleet.options.whole).await?;
        Ok(fleet)
    }

    /// What no query sees.
    #[must_use]
    pub fn left_out(&self) -> &[LeftOut] {
        &self.left_out
    }

    /// The engine.
    #[must_use]
    pub const fn context(&self) -> &SessionContext {
        &self.context
    }

    /// Answers a query. Where it fails, all files are read as a whole, and if some can't be, the query is asked
    /// again without them.
    ///
    /// # Errors
    /// A query that is none, or that fails for another reason than a file.
    pub async fn sql(&mut self, query: &str) -> Result<Vec<RecordBatch>> {
        let first = self.answer(query).await;
        if first.is_ok()
            || self.options.whole
            || first
                .as_ref()
                .is_err_and(|error| lost(error) || error.to_string().contains(LATE))
            || matches!(
                first,
                Err(DataFusionError::Plan(_)
                    | DataFusionError::SQL(..)
                    | DataFusionError::SchemaError(..))
            )
        {
            return first;
        }
        let before = self.left_out.len();
        self.register(true).await?;
        match self.left_out.len() > before {
            true => self.answer(query).await,
            false => first,
        }
    }

    /// Answers a query within the limit, again where an executor of a cluster was lost.
    async fn answer(&self, query: &str) -> Result<Vec<RecordBatch>> {
        let attempts = match self.options.scheduler {
            Some(_) => ATTEMPTS,
            None => 1,
        };
        let asked = async {
            let mut last = None;
            for _ in 0..attempts {
                let rows = async { self.context.sql(query).await?.collect().await };
                match rows.await {
                    Err(error) if lost(&error) => {
                        last = Some(error);
                        tokio::time::sleep(PAUSE).await;
                    }
                    other => return other,
                }
            }
            let why = last.map_or_else(String::new, |error| error.strip_backtrace());
            Err(DataFusionError::Execution(format!(
                "executors were lost in each of {attempts} attempts at the query: see whether scheduler and executors \
                 run and can reach each other (`--log info` makes them tell), then ask again\n  {why}"
            )))
        };
        let Some(limit) = self.options.limit else {
            return asked.await;
        };
        let late = |_| {
            DataFusionError::Execution(format!(
                "{LATE} {} s: give it more time with `--limit SECONDS`, or more partitions and \
                 executors; if it always takes that long, see whether all executors run (`--log info` makes \
                 scheduler and executors tell)",
                limit.as_secs_f64()
            ))
        };
        tokio::time::timeout(limit, asked).await.map_err(late)?
    }

    async fn register(&mut self, whole: bool) -> Result<()> {
        self.left_out.clear();
        if let Some(folder) = self.options.factors.clone() {
            self.register_factors(&folder, whole).await?;
        }
        if let Some(folder) = self.options.logs.clone() {
            self.register_logs(&folder, whole).await?;
        }
        Ok(())
    }

    async fn register_factors(&mut self, folder: &Path, whole: bool) -> Result<()> {
        let catalog = Catalog::of_factors(&parquet_files(folder)?, whole).await?;
        self.left_out.extend(catalog.left_out);
        none_left(&catalog.files, folder, &self.left_out)?;
        let table = self.table(&catalog.files).await?;
        self.put("factor_rows", table)?;
        let simple: Vec<PathBuf> = { catalog.files.iter() }
            .filter(|file| !catalog.copies.contains_key(*file))
            .cloned()
            .collect();
        let mut factors = match simple.is_empty() {
            true => None,
            false => Some(self.table(&simple).await?),
        };
        for (file, copies) in catalog.copies {
            let copies = copies.into_iter().map(lit).collect();
            let own = self.table(&[file]).await?;
            let own = own.filter(col("content").in_list(copies, true))?;
            factors = Some(match factors {
                Some(all) => all.union(own)?,
                None => own,
            });
        }
        let factors = factors
            .ok_or_else(|| DataFusionError::Execution("no factor file can be read".to_owned()))?;
        self.put("factors", factors.filter(col("kind").eq(lit("factor")))?)
    }

    async fn register_logs(&mut self, folder: &Path, whole: bool) -> Result<()> {
        let files = parquet_files(folder)?;
        let catalog = Catalog::of_logs(&files, whole).await?;
        self.left_out.extend(catalog.left_out);
        none_left(&catalog.files, folder, &self.left_out)?;
        let mut root = folder.to_owned();
        if catalog.files.len() < files.len() {
            // The engine finds the columns of a folder's names below one root, so good files get one of their own.
            let links = TempDir::new()?;
            for file in &catalog.files {
                let relative = file.strip_prefix(folder).unwrap_or(file);
                let link = links.path().join(relative);
                std::fs::create_dir_all(link.parent().unwrap_or(links.path()))?;
                link_to(&std::path::absolute(file)?, &link)?;
            }
            root = links.path().to_owned();
            self.links = Some(links);
        }
        let columns = ["serial", "day"].map(|name| (name.to_owned(), DataType::Utf8));
        let options = listing().with_table_partition_cols(columns.to_vec());
        let url = ListingTableUrl::parse(format!("{}/", text(&root)))?;
        let config = ListingTableConfig::new(url).with_listing_options(options);
        let config = config.infer_schema(&self.context.state()).await?;
        let table = self
            .context
            .read_table(Arc::new(ListingTable::try_new(config)?))?;
        self.put("logs", table)
    }

    async fn table(&self, files: &[PathBuf]) -> Result<DataFrame> {
        let urls = files.iter().map(|file| ListingTableUrl::parse(text(file)));
        let config = ListingTableConfig::new_with_multi_paths(urls.collect::<Result<_>>()?)
            .with_listing_options(listing());
        let config = config.infer_schema(&self.context.state()).await?;
        self.context
            .read_table(Arc::new(ListingTable::try_new(config)?))
    }

    fn put(&self, name: &str, table: DataFrame) -> Result<()> {
        self.context.deregister_table(name)?;
        self.context
            .register_table(name, table.into_view())
            .map(drop)
    }
}

#[cfg(unix)]
fn link_to(file: &Path, link: &Path) -> std::io::Result<()> {
    std::os::unix::fs::symlink(file, link)
}

#[cfg(not(unix))]
fn link_to(file: &Path, link: &Path) -> std::io::Result<()> {
    std::fs::copy(file, link).map(drop)
}

fn listing() -> ListingOptions {
    ListingOptions::new(Arc::new(ParquetFormat::default())).with_file_extension(".parquet")
}

fn none_left(files: &[PathBuf], folder: &Path, left_out: &[LeftOut]) -> Result<()> {
    if !files.is_empty() {
        return Ok(());
    }
    let why = left_out
        .iter()
        .map(|own| format!("\n  {}: {}", own.file, own.why));
    let why: String = why.take(10).collect();
    let message = format!(
        "{}: there is no file that can be read{why}",
        folder.display()
    );
    Err(DataFusionError::Execution(message))
}

/// How queries are run.
#[must_use]
pub fn config(partitions: usize) -> SessionConfig {
    let config = SessionConfig::new().set_bool(
        "datafusion.execution.parquet.schema_force_view_types",
        false,
    );
    match partitions {
        0 => config,
        count => config.with_target_partitions(count),
    }
}

async fn context(options: &Options) -> Result<SessionContext> {
    let config = config(options.partitions);
    let context = match &options.scheduler {
        Some(url) => remote(url, config).await?,
        None => {
            let runtime = RuntimeEnvBuilder::new();
            let runtime = match options.memory {
                0 => runtime,
                bytes => runtime.with_memory_pool(Arc::new(FairSpillPool::new(bytes))),
            };
            SessionContext::new_with_config_rt(config, runtime.build_arc()?)
        }
    };
    for own in functions::aggregates(&options.robots) {
        context.register_udaf(Arc::unwrap_or_clone(own));
    }
    for own in functions::scalars() {
        context.register_udf(Arc::unwrap_or_clone(own));
    }
    Ok(context)
}

#[cfg(feature = "distributed")]
async fn remote(url: &str, config: SessionConfig) -> Result<SessionContext> {
    crate::distributed::client(url, config).await
}

#[cfg(not(feature = "distributed"))]
async fn remote(_: &str, _: SessionConfig) -> Result<SessionContext> {
    Err(DataFusionError::Plan(
        "this program was built without the feature `distributed`".to_owned(),
    ))
}
