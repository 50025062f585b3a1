//! Processing order for items that each depend on at most one other item.

/// Items in an order in which each comes after the item it depends on, and cycles of items.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Chains {
    /// All items, those in cycles included.
    pub(super) order: Vec<usize>,
    /// Each cycle once, every item followed by the one it depends on.
    pub(super) circles: Vec<Vec<usize>>,
}

impl Chains {
    /// Orders items; `follows` gives for each item the index of the item it depends on, if any.
    pub(super) fn of(follows: &[Option<usize>]) -> Self {
        #[derive(Clone, Copy, PartialEq)]
        enum State {
            New,
            OnPath,
            Done,
        }
        let mut state = vec![State::New; follows.len()];
        let mut chains = Self::default();
        let mut path = Vec::new();
        // Iterative: a chain may be as long as a list.
        for start in 0..follows.len() {
            let mut next = Some(start);
            while let Some(at) = next.filter(|&at| state.get(at) == Some(&State::New)) {
                state[at] = State::OnPath;
                path.push(at);
                next = follows[at];
            }
            if let Some(at) = next.filter(|&at| state.get(at) == Some(&State::OnPath))
                && let Some(from) = path.iter().position(|&other| other == at)
            {
                chains.circles.push(path[from..].to_vec());
            }
            path.iter().for_each(|&at| state[at] = State::Done);
            chains.order.extend(path.drain(..).rev());
        }
        chains
    }

    /// Whether the item at this index is part of a cycle.
    pub(super) fn is_circular(&self, index: usize) -> bool {
        self.circles.iter().any(|circle| circle.contains(&index))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_comes_behind_the_one_it_follows() {
        let chains = Chains::of(&[Some(2), None, Some(1), Some(2)]);
        assert_eq!(chains.order, [1, 2, 0, 3]);
        assert_eq!(chains.circles, [] as [Vec<usize>; 0]);
    }

    #[test]
    fn circles_are_found_once_and_those_who_lead_into_them_are_none() {
        // 0 depends on itself; 1, 2 and 3 form a cycle; 4 depends on one of them.
        let chains = Chains::of(&[Some(0), Some(2), Some(3), Some(1), Some(3)]);
        assert_eq!(chains.circles, [vec![0], vec![1, 2, 3]]);
        assert!(!chains.is_circular(4));
        let mut order = chains.order.clone();
        order.sort_unstable();
        assert_eq!(order, [0, 1, 2, 3, 4]);
    }

    #[test]
    fn long_chains_need_no_stack() {
        let follows: Vec<_> = (0..1_000_000_usize)
            .map(|at| at.checked_sub(1))
            .rev()
            .map(|at| at.map(|at| 999_999 - at))
            .collect();
        let chains = Chains::of(&follows);
        assert_eq!((chains.order.len(), chains.circles.len()), (1_000_000, 0));
    }
}
