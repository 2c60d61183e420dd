//! Where files are: below a folder of this machine, or below a prefix of a bucket with the interface of S3.
//!
//! Every process reads by itself, so a bucket is what machines without a common folder share. Address and keys come
//! from the environment (`AWS_ENDPOINT_URL`, `AWS_REGION`, `AWS_ACCESS_KEY_ID`, …), of the client, the scheduler and
//! each executor.

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

/// The scheme of what has the interface of S3.
const S3: &str = "s3";

/// A folder, or what is below a prefix of a bucket.
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
        match url.host_str().is_some_and(|bucket| !bucket.is_empty()) {
            true => Ok(Self::Bucket(url)),
            false => Err(format!("there is no bucket in `{text}`: {way_out}")),
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
    /// All files below it whose names end in `.parquet`, in order.
    ///
    /// # Errors
    /// A place that can't be read.
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

    /// Its address as a folder, for an engine that finds columns in the names below it.
    #[must_use]
    pub fn root(&self) -> String {
        format!("{}/", self.to_string().trim_end_matches('/'))
    }
}

/// A file to a URL that the query engine reads.
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

/// The stores that a process knows: this machine's files, and each bucket from when it is first asked for.
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

/// A bucket, as the environment says where it is.
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

/// What queries run with, in each process.
pub(crate) fn runtime() -> RuntimeEnvBuilder {
    RuntimeEnvBuilder::new().with_object_store_registry(Arc::new(Stores::default()))
}
