//! The grid of cells that piles stand on.

/// A grid of cells, row by row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Grid {
    pub(crate) across: usize,
    pub(crate) along: usize,
}

impl Grid {
    /// The number of cells.
    pub(crate) fn cells(self) -> usize {
        self.across * self.along
    }

    /// The cells beside a cell.
    pub(super) fn beside(self, cell: usize) -> impl Iterator<Item = usize> {
        let (x, y) = (cell % self.across, cell / self.across);
        let west = (x > 0).then(|| cell - 1);
        let east = (x + 1 < self.across).then_some(cell + 1);
        let south = (y > 0).then(|| cell - self.across);
        let north = (y + 1 < self.along).then_some(cell + self.across);
        [west, east, south, north].into_iter().flatten()
    }

    /// So many cells in x and in y.
    pub(crate) fn of([across, along]: [usize; 2]) -> Self {
        Self { across, along }
    }

    /// The smallest grids that hold so many parts, the squarest first: all of the smallest area, then some of larger ones.
    pub(crate) fn for_parts(count: usize) -> Vec<Self> {
        let mut grids: Vec<Self> = Vec::new();
        for area in count..=count + count.div_ceil(3) {
            for along in (1..=area).filter(|along| along * along <= area && area.is_multiple_of(*along)).rev()
            {
                grids.push(Self { across: area / along, along });
            }
        }
        grids
    }
}
