//! Locations of files: a folder, or a prefix of a bucket with an S3 interface.
//!
//! Every process reads by itself, so machines without a common folder share a bucket. Client,
//! scheduler and each executor take address and keys from the environment (`AWS_ENDPOINT_URL`,
//! `AWS_REGION`, `AWS_ACCESS_KEY_ID`, …).

use datafusion::object_store::ObjectStore;
use datafusion::{
    datasource::listing::ListingTableUrl,
    error::{DataFusionError, Result},
    execution::{
        object_store::{DefaultObjectStoreRegistry, ObjectStoreRegistry},
        runtime_env::{RuntimeEnv, RuntimeEnvBuilder},
    },
};
use futures::TryStreamExt;
use std::{
    fmt,
    path::{Path, PathBuf},
    str::FromStr,
    sync::Arc,
};
use url::Url;

/// URL scheme of S3.
const S3: &str = "s3";

/// A folder, or a prefix of a bucket.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Place {
    /// A folder of this machine.
    Folder(PathBuf),
    /// `s3://BUCKET/PREFIX`.
    Bucket(Url),
}

impl From<PathBuf> for Place {
    fn from(folder: PathBuf) -> Self {
        Self::Folder(folder)
    }
}

impl FromStr for Place {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let Some((scheme, _)) = text.split_once("://") else {
            return Ok(Self::Folder(text.into()));
        };
        let way_out = "write a folder, or `s3://BUCKET/PREFIX`";
        if scheme != S3 {
            return Err(format!("files are not read from `{scheme}://`: {way_out}"));
        }
        let url = Url::parse(text).map_err(|error| format!("{error}: {way_out}"))?;
        if url.host_str().is_some_and(|bucket| !bucket.is_empty()) {
            Ok(Self::Bucket(url))
        } else {
            Err(format!("there is no bucket in `{text}`: {way_out}"))
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Folder(folder) => folder.display().fmt(f),
            Self::Bucket(url) => url.fmt(f),
        }
    }
}

impl Place {
    /// All files below it with the extension `.parquet`, sorted.
    ///
    /// # Errors
    /// A place that cannot be read.
    pub async fn parquet_files(&self, runtime: &RuntimeEnv) -> Result<Vec<String>> {
        match self {
            Self::Folder(folder) => {
                let files = below(folder)
                    .map_err(|error| failed(&format!("{}: {error}", folder.display())))?;
                Ok(files.iter().map(|file| text(file)).collect())
            }
            Self::Bucket(url) => in_bucket(url, runtime).await,
        }
    }

    /// Address with a trailing slash, for an engine that derives columns from folder names.
    #[must_use]
    pub fn root(&self) -> String {
        format!("{}/", self.to_string().trim_end_matches('/'))
    }
}

/// Path as text for the query engine.
pub(crate) fn text(path: &Path) -> String {
    path.display().to_string()
}

fn failed(message: &str) -> DataFusionError {
    DataFusionError::Execution(message.to_owned())
}

fn is_parquet(path: &Path) -> bool {
    path.extension().is_some_and(|own| own == "parquet")
}

fn below(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    if folder.is_file() {
        return Ok(vec![folder.to_owned()]);
    }
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder)? {
            let path = entry?.path();
            if path.is_dir() {
                folders.push(path);
            } else if is_parquet(&path) {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}

async fn in_bucket(url: &Url, runtime: &RuntimeEnv) -> Result<Vec<String>> {
    let told = |error: &dyn fmt::Display| {
        failed(&format!(
            "{url}: {error}\n  address and keys come from the environment: AWS_ENDPOINT_URL, AWS_REGION, \
             AWS_ACCESS_KEY_ID, AWS_SECRET_ACCESS_KEY, and AWS_ALLOW_HTTP=true where the address is http://"
        ))
    };
    let own = ListingTableUrl::parse(url.as_str())?;
    let store = runtime.object_store(&own)?;
    let listed: Vec<_> = store
        .list(Some(own.prefix()))
        .map_ok(|found| found.location)
        .try_collect()
        .await
        .map_err(|error| told(&error))?;
    let names = listed.iter().map(AsRef::<str>::as_ref);
    let mut files: Vec<String> = names
        .filter(|name| is_parquet(Path::new(name)))
        .map(|name| {
            let mut file = url.clone();
            file.set_path(name);
            file.to_string()
        })
        .collect();
    files.sort();
    Ok(files)
}

/// Object stores of a process: local files, and buckets opened on first use.
#[derive(Debug, Default)]
struct Stores(DefaultObjectStoreRegistry);

impl ObjectStoreRegistry for Stores {
    fn register_store(
        &self,
        url: &Url,
        store: Arc<dyn ObjectStore>,
    ) -> Option<Arc<dyn ObjectStore>> {
        self.0.register_store(url, store)
    }

    fn deregister_store(&self, url: &Url) -> Result<Arc<dyn ObjectStore>> {
        self.0.deregister_store(url)
    }

    fn get_store(&self, url: &Url) -> Result<Arc<dyn ObjectStore>> {
        let known = self.0.get_store(url);
        let bucket = url.host_str().filter(|_| url.scheme() == S3);
        let (Err(_), Some(bucket)) = (&known, bucket) else {
            return known;
        };
        let store = opened(bucket).map_err(|error| failed(&format!("{url}: {error}")))?;
        self.0.register_store(url, store.clone());
        Ok(store)
    }
}

/// Opens a bucket with settings from the environment.
#[cfg(feature = "s3")]
fn opened(bucket: &str) -> Result<Arc<dyn ObjectStore>, String> {
    let store = object_store::aws::AmazonS3Builder::from_env().with_bucket_name(bucket);
    match store.build() {
        Ok(store) => Ok(Arc::new(store)),
        Err(error) => Err(error.to_string()),
    }
}

#[cfg(not(feature = "s3"))]
fn opened(_: &str) -> Result<Arc<dyn ObjectStore>, String> {
    Err("this program was built without the feature `s3`".to_owned())
}

/// Runtime environment of queries in each process.
pub(crate) fn runtime() -> RuntimeEnvBuilder {
    RuntimeEnvBuilder::new().with_object_store_registry(Arc::new(Stores::default()))
}
