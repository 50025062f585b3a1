//! A crowd on several cores.

use std::num::NonZeroUsize;

use crate::sense_support::Crowd;
use underfoot::parallel::ThreadPool;
use underfoot::sense::{Contact, ForceFrame, Method, Sensing};

/// All contacts of all frames, found with `threads` threads.
fn found(crowd: &Crowd, threads: usize) -> Vec<Vec<Contact>> {
    let pool = ThreadPool::new(NonZeroUsize::new(threads).unwrap()).unwrap();
    pool.run(|| {
        let mut sensing = Sensing::new(crowd.geometry, Method::Tracker);
        let mut frame = ForceFrame::empty(&crowd.geometry);
        let mut before = None;
        let contacts = crowd.moments.iter().map(|moment| {
            moment.show(&mut frame, before.replace(moment));
            sensing.update(&frame).to_vec()
        });
        contacts.collect()
    })
}

#[test]
fn a_crowd_is_sensed_alike_by_any_number_of_threads() {
    // Enough feet for the use of a pool, and enough time for each to land, to meet another and to leave.
    let crowd = Crowd::of(60, 200, 600);
    let alone = found(&crowd, 1);
    assert!(alone.iter().all(|contacts| contacts.len() > 150), "a crowd");
    assert!(alone.iter().flatten().any(|contact| contact.ambiguous), "with feet that share tiles");
    for threads in [2, 3, 8] {
        let shared = found(&crowd, threads);
        let differs = shared.iter().zip(&alone).position(|(shared, alone)| shared != alone);
        assert_eq!(differs, None, "{threads} threads");
    }
}
