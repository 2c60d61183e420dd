//! Queries over the factor files and logs of a fleet, on this machine or on a cluster.
//!
//! - `factor_rows`: all rows of readable factor files;
//! - `factors`: the rows with factors, each run once, from its first file;
//! - `logs`: the rows of all logs, with the columns `serial` and `day` from folder names.

use crate::{
    catalog::{Catalog, LeftOut},
    days::Days,
    functions,
    robots::Robots,
    store::{self, Place},
};
use arrow::{datatypes::DataType, record_batch::RecordBatch};
use datafusion::{
    datasource::{
        file_format::parquet::ParquetFormat,
        listing::{ListingOptions, ListingTable, ListingTableConfig, ListingTableUrl},
    },
    error::{DataFusionError, Result},
    execution::memory_pool::FairSpillPool,
    logical_expr::{col, lit},
    prelude::{DataFrame, ParquetReadOptions, SessionConfig, SessionContext},
};
use std::{path::Path, sync::Arc, time::Duration};
use tempfile::TempDir;

/// Settings of a fleet session.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// Location of factor files.
    pub factors: Option<Place>,
    /// Location of logs, `serial=…/day=…/….parquet`.
    pub logs: Option<Place>,
    /// Descriptions for `factor`.
    pub robots: Robots,
    /// Scheduler of a cluster, `df://host:port`; `None` for this machine.
    pub scheduler: Option<String>,
    /// Number of concurrent partitions; the number of cores if 0.
    pub partitions: usize,
    /// Memory limit of a query on this machine, bytes; unlimited if 0.
    pub memory: usize,
    /// Whether to read all files completely before the first query, not only after a failure.
    pub whole: bool,
    /// Time limit of a query, if any.
    pub limit: Option<Duration>,
}

/// Largest number of attempts of a cluster query, which the scheduler ends if executors are lost.
///
/// A killed executor may end two: one that cannot fetch its results and one that starts on it.
const ATTEMPTS: usize = 5;

/// Time between two attempts.
const PAUSE: Duration = Duration::from_millis(500);

/// Parts of the engine's messages on lost executors; its errors contain only text.
const LOST: [&str; 7] = [
    "failed: Cancelled",
    "has failed 1 times",
    "GrpcConnectionError",
    "Shuffle fetch partition error",
    "executors were lost",
    "transport error",
    "h2 protocol error",
];

/// Message on a query that exceeds the time limit.
const LATE: &str = "the query did not end within";

/// The engine's message on an inaccessible file; it does not mean a lost executor.
const NO_FILE: &str = "Object Store error";

fn lost(error: &DataFusionError) -> bool {
    let text = error.to_string();
    LOST.iter().any(|own| text.contains(own)) && !text.contains(NO_FILE)
}

/// Error of a cluster; for a file with advice, because this machine could read it.
fn of_cluster(error: DataFusionError) -> DataFusionError {
    let text = error.strip_backtrace();
    if !text.contains(NO_FILE) {
        return error;
    }
    DataFusionError::Execution(format!(
        "{}\n  scheduler and executors read files themselves: a folder must exist under the same path on each, \
         and for a bucket each needs AWS_ENDPOINT_URL, AWS_REGION, AWS_ACCESS_KEY_ID, AWS_SECRET_ACCESS_KEY, and \
         AWS_ALLOW_HTTP=true where the address is http://, in its environment",
        text.trim_end()
    ))
}

/// A session with a fleet.
pub struct Fleet {
    options: Options,
    context: SessionContext,
    /// Context that checks files on this machine, whoever runs the queries.
    files: SessionContext,
    left_out: Vec<LeftOut>,
    /// Links to the readable logs, if some are not.
    links: Option<TempDir>,
}

impl Fleet {
    /// Checks the files and registers the tables.
    ///
    /// # Errors
    /// A folder or scheduler that cannot be reached, or no readable file.
    pub async fn open(options: Options) -> Result<Self> {
        let context = context(&options).await?;
        let mut fleet = Self {
            options,
            context,
            files: SessionContext::new_with_config_rt(config(0), store::runtime().build_arc()?),
            left_out: Vec::new(),
            links: None,
        };
        fleet.register(fleet.options.whole).await?;
        Ok(fleet)
    }

    /// Files and runs that queries ignore.
    #[must_use]
    pub fn left_out(&self) -> &[LeftOut] {
        &self.left_out
    }

    /// Context of the query engine.
    #[must_use]
    pub const fn context(&self) -> &SessionContext {
        &self.context
    }

    /// Runs a query.
    ///
    /// If it fails, all files are read completely. If some are unreadable, the query is repeated
    /// without them.
    ///
    /// # Errors
    /// An invalid query, or a failure that no file caused.
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
        if self.left_out.len() > before {
            self.answer(query).await
        } else {
            first
        }
    }

    /// Runs a query within the time limit, again if an executor was lost.
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
                    other if attempts > 1 => return other.map_err(of_cluster),
                    other => return other,
                }
            }
            let why = last.map_or_else(String::new, |error| error.strip_backtrace());
            Err(DataFusionError::Execution(format!(
                "executors were lost in each of {attempts} attempts at the query: check that scheduler and executors run and reach each other (`--log info` prints their messages), then repeat the query\n  {why}"
            )))
        };
        let Some(limit) = self.options.limit else {
            return asked.await;
        };
        let late = |_| {
            DataFusionError::Execution(format!(
                "{LATE} {} s: give it more time with `--limit SECONDS`, or more partitions and \
                 executors; if it always takes that long, check that all executors run (`--log info` prints their messages)",
                limit.as_secs_f64()
            ))
        };
        tokio::time::timeout(limit, asked).await.map_err(late)?
    }

    async fn register(&mut self, whole: bool) -> Result<()> {
        self.left_out.clear();
        if let Some(place) = self.options.factors.clone() {
            self.register_factors(&place, whole).await?;
        }
        if let Some(place) = self.options.logs.clone() {
            self.register_logs(&place, whole).await?;
        }
        Ok(())
    }

    async fn register_factors(&mut self, place: &Place, whole: bool) -> Result<()> {
        let files = place.parquet_files(&self.files.runtime_env()).await?;
        let catalog = Catalog::of_factors(&self.files, &files, whole).await?;
        self.left_out.extend(catalog.left_out);
        none_left(&catalog.files, place, &self.left_out)?;
        let table = self.table(&catalog.files).await?;
        self.put("factor_rows", table)?;
        let simple: Vec<String> = { catalog.files.iter() }
            .filter(|file| !catalog.copies.contains_key(*file))
            .cloned()
            .collect();
        let mut factors = if simple.is_empty() {
            None
        } else {
            Some(self.table(&simple).await?)
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

    async fn register_logs(&mut self, place: &Place, whole: bool) -> Result<()> {
        let files = place.parquet_files(&self.files.runtime_env()).await?;
        let catalog = Catalog::of_logs(&self.files, &files, whole).await?;
        self.left_out.extend(catalog.left_out);
        none_left(&catalog.files, place, &self.left_out)?;
        let all = catalog.files.len() == files.len();
        let table = match place {
            Place::Folder(folder) if !all => {
                let links = linked(folder, &catalog.files)?;
                let root = Place::Folder(links.path().to_owned());
                self.links = Some(links);
                self.logs_below(&root, None).await?
            }
            Place::Bucket(_) if !all => {
                // A bucket has no links, so whole days with an unreadable file are excluded.
                let days = Days::without(&files, &catalog.files);
                self.left_out.extend(days.left_out);
                none_left(&days.files, place, &self.left_out)?;
                let table = self.logs_below(place, days.files.first()).await?;
                table.filter(days.filter)?
            }
            _ => self.logs_below(place, None).await?,
        };
        self.put("logs", table)
    }

    /// All logs below a place; the columns are those of `file`, or of all files.
    async fn logs_below(&self, place: &Place, file: Option<&String>) -> Result<DataFrame> {
        let columns = ["serial", "day"].map(|name| (name.to_owned(), DataType::Utf8));
        let options = listing().with_table_partition_cols(columns.to_vec());
        let url = ListingTableUrl::parse(place.root())?;
        let config = ListingTableConfig::new(url).with_listing_options(options);
        let config = match file {
            Some(file) => {
                let own = self
                    .files
                    .read_parquet(file.as_str(), ParquetReadOptions::default());
                config.with_schema(Arc::clone(own.await?.schema().inner()))
            }
            None => config.infer_schema(&self.context.state()).await?,
        };
        self.context
            .read_table(Arc::new(ListingTable::try_new(config)?))
    }

    async fn table(&self, files: &[String]) -> Result<DataFrame> {
        let urls = files.iter().map(ListingTableUrl::parse);
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

/// Folder of links to files, because the engine derives folder columns below a single root.
fn linked(folder: &Path, files: &[String]) -> Result<TempDir> {
    let links = TempDir::new()?;
    for file in files.iter().map(Path::new) {
        let link = links.path().join(file.strip_prefix(folder).unwrap_or(file));
        std::fs::create_dir_all(link.parent().unwrap_or(links.path()))?;
        link_to(&std::path::absolute(file)?, &link)?;
    }
    Ok(links)
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

fn none_left(files: &[String], place: &Place, left_out: &[LeftOut]) -> Result<()> {
    if !files.is_empty() {
        return Ok(());
    }
    let why = left_out
        .iter()
        .map(|own| format!("\n  {}: {}", own.file, own.why));
    let why: String = why.take(10).collect();
    let message = format!("{place}: there is no readable file{why}");
    Err(DataFusionError::Execution(message))
}

/// Configuration of queries.
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
            let runtime = store::runtime();
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
