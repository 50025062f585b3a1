//! Live reload: a saved layout, kind or effect is on the floor at once.

use std::path::PathBuf;
use std::time::Duration;

use notify_debouncer_full::notify::{RecommendedWatcher, RecursiveMode};
use notify_debouncer_full::{DebounceEventResult, Debouncer, RecommendedCache, new_debouncer};
use tracing::warn;
use underfoot::floor::Geometry;
use underfoot::layout::Layout;
use underfoot::schema::{self, Diagnostics};

use super::failure::Failure;
use super::layout_args::LayoutArgs;

/// How long a file must be left alone before it is read: editors write in several steps, which follow each other within
/// some milliseconds.
const QUIET: Duration = Duration::from_millis(80);

/// How often it is asked whether that time is over. Each time wakes a processor that may sleep.
const TICK: Duration = Duration::from_millis(40);

/// Watches files for as long as it lives.
pub(crate) struct Watch {
    _debouncer: Debouncer<RecommendedWatcher, RecommendedCache>,
}

impl Watch {
    /// Calls `tell` with the layout, or with what is wrong with it, each time its file or a kind's or an effect's file
    /// is saved.
    ///
    /// Gives `None` for a built-in layout, which has no file.
    pub(crate) fn start(
        files: &LayoutArgs,
        geometry: Geometry,
        tell: impl Fn(Result<Layout, Diagnostics>) + Send + 'static,
    ) -> Result<Option<Self>, Failure> {
        let Some(path) = files.path().map(PathBuf::from) else { return Ok(None) };
        let own = files.clone();
        Self::on_change(files, move || tell(read(&own, &path, &geometry)))
    }

    /// Calls `tell` each time the layout's file or a kind's or an effect's file is saved.
    ///
    /// Gives `None` for a built-in layout, which has no file.
    pub(crate) fn on_change(
        files: &LayoutArgs,
        tell: impl Fn() + Send + 'static,
    ) -> Result<Option<Self>, Failure> {
        let Some(path) = files.path() else { return Ok(None) };
        let folders: Vec<PathBuf> =
            [files.kinds_folder(), files.effects_folder()].into_iter().flatten().collect();
        // Many editors replace the file, which would end a watch on the file itself.
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        let folder = folder.map_or_else(|| PathBuf::from("."), PathBuf::from);
        let watched: Vec<PathBuf> = std::iter::once(folder).chain(folders.iter().cloned()).collect();
        let name = path.file_name().map(ToOwned::to_owned);
        let on_change = move |events: DebounceEventResult| {
            let Ok(events) = events else { return };
            let concerns_us = events.iter().filter(|event| !event.kind.is_access()).any(|event| {
                event.paths.iter().any(|changed| {
                    changed.file_name() == name.as_deref()
                        || folders.iter().any(|folder| {
                            changed.extension().is_some_and(|ending| ending == "ron")
                                && changed.parent().map(std::path::Path::file_name)
                                    == Some(folder.file_name())
                        })
                })
            });
            if concerns_us {
                tell();
            }
        };
        let failed = |error: notify_debouncer_full::notify::Error| {
            Failure::Other(format!("the layout's folder can't be watched for changes: {error}"))
        };
        let mut debouncer = new_debouncer(QUIET, Some(TICK), on_change).map_err(failed)?;
        for folder in watched {
            debouncer.watch(&folder, RecursiveMode::NonRecursive).map_err(failed)?;
        }
        Ok(Some(Self { _debouncer: debouncer }))
    }
}

fn read(files: &LayoutArgs, path: &std::path::Path, geometry: &Geometry) -> Result<Layout, Diagnostics> {
    let kinds = files.kinds()?;
    let loaded = schema::load_layout(path, &kinds, geometry)?;
    if !loaded.warnings.is_empty() {
        warn!("{}", loaded.warnings);
    }
    Ok(loaded.layout)
}
