//! The screens of this computer, and the order in which projectors go through them.

/// Number of screens to choose from while the number of connected ones is unknown.
const MOST: usize = 8;

/// The screens connected to this computer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::preview) struct ConnectedScreens {
    pub(in crate::preview) count: usize,
    /// The screen of the main window, numbered by the system from 0.
    pub(in crate::preview) own: Option<usize>,
}

/// Number of screens to choose from; `None` stands for unknown ones.
pub(super) fn count(connected: Option<ConnectedScreens>) -> usize {
    connected.map_or(MOST, |screens| screens.count)
}

/// Whether this screen is connected, or may be.
pub(super) fn has(connected: Option<ConnectedScreens>, screen: usize) -> bool {
    connected.is_none_or(|screens| screen < screens.count)
}

/// The screen after `now` of `count` ones, without the one that is `taken` if there is another.
pub(super) fn next_screen(now: Option<usize>, taken: Option<usize>, count: usize) -> Option<usize> {
    let count = count.max(1);
    let first = now.map_or(0, |now| now + 1);
    let mut order = (0..count).map(|step| (first + step) % count);
    order.find(|screen| taken != Some(*screen) || count == 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_projector_goes_from_screen_to_screen_past_that_of_the_other() {
        assert_eq!(next_screen(None, None, 3), Some(0));
        assert_eq!(next_screen(Some(2), None, 3), Some(0));
        assert_eq!(next_screen(Some(0), Some(1), 3), Some(2));
        assert_eq!(next_screen(Some(0), Some(1), 2), Some(0));
        assert_eq!(next_screen(Some(7), Some(0), 1), Some(0), "there is only one");
    }
}
