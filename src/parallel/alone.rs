//! The same work on the calling thread, where there is no pool.

pub(crate) fn for_each<T: Send>(items: &mut [T], work: impl Fn(usize, &mut T) + Sync) {
    items.iter_mut().enumerate().for_each(|(position, item)| work(position, item));
}

pub(crate) fn for_each_batch<T: Send>(batches: &mut [T], _: usize, work: impl Fn(usize, &mut T) + Sync) {
    for_each(batches, work);
}

pub(crate) fn with_pool_awake(_: usize, frame: impl FnOnce() + Send) {
    frame();
}

#[cfg(feature = "net")]
pub(crate) fn on_each_thread(work: impl Fn() + Sync) {
    work();
}
