//! Products of columns and residual by section of a run's time.

pub(super) mod live_columns;

use nalgebra::{DMatrix, DMatrixViewMut, DVector};

use super::columns::Layout;
use crate::estimation::correlation::square;
use live_columns::LiveColumns;

/// Products of columns and residual, one column per section or cosine.
///
/// Cosines are cos(π m (k + 1/2)/K) over the K sections, m = 0 … 2 B. W are the columns of the base
/// parameters, Z all columns.
#[derive(Debug, Clone)]
pub(super) struct Products {
    /// Wᵀ Z, p × columns, weighted.
    pub(super) cross: DMatrix<f64>,
    /// Products of the columns of each block with each other, block by block.
    pub(super) own: DMatrix<f64>,
    /// Zᵀ ρ.
    pub(super) scores: DMatrix<f64>,
}

/// Weighted rows of a line or of several lines with the same live columns, and their residual.
pub(super) struct WeightedRows {
    pub(super) columns: DMatrix<f64>,
    pub(super) residual: DVector<f64>,
}

/// Lines with the same live columns, and where these columns are.
#[derive(Debug, Clone)]
pub(super) struct LineGroup {
    /// Number of the lines.
    pub(super) lines: Vec<usize>,
    /// Live columns among all.
    columns: Vec<usize>,
    /// Number of the model's columns, which come first.
    models: usize,
    /// Blocks with live columns.
    blocks: Vec<LiveBlock>,
}

/// Live columns of a block.
#[derive(Debug, Clone)]
struct LiveBlock {
    block: usize,
    /// Indices in the block, and among the live columns.
    inside: Vec<usize>,
    places: Vec<usize>,
}

impl LineGroup {
    /// Groups of lines with the same live columns.
    pub(super) fn all(layout: &Layout, lines: &[LiveColumns]) -> Vec<Self> {
        let mut groups: Vec<Self> = Vec::new();
        for (line, live) in lines.iter().enumerate() {
            match groups
                .iter_mut()
                .find(|group| group.columns == live.columns)
            {
                Some(group) => group.lines.push(line),
                None => groups.push(Self::new(layout, line, live)),
            }
        }
        groups
    }

    fn new(layout: &Layout, line: usize, live: &LiveColumns) -> Self {
        let indices = live.indices(layout.columns);
        let block = |(block, columns): (usize, &Vec<usize>)| {
            let own = columns.iter().enumerate();
            let own = own.filter_map(|(inside, column)| Some((inside, indices[*column]?)));
            let (inside, places): (Vec<usize>, Vec<usize>) = own.unzip();
            let block = LiveBlock {
                block,
                inside,
                places,
            };
            (!block.places.is_empty()).then_some(block)
        };
        Self {
            lines: vec![line],
            columns: live.columns.clone(),
            models: live.models(),
            blocks: layout.blocks.iter().enumerate().filter_map(block).collect(),
        }
    }
}

impl Products {
    /// Products without rows.
    pub(super) fn new(layout: &Layout, sections: usize) -> Self {
        Self {
            cross: DMatrix::zeros(layout.base * layout.columns, sections),
            own: DMatrix::zeros(layout.squares, sections),
            scores: DMatrix::zeros(layout.columns, sections),
        }
    }

    /// Adds rows of a group of lines to a section.
    pub(super) fn add(
        &mut self,
        layout: &Layout,
        section: usize,
        group: &LineGroup,
        rows: &WeightedRows,
    ) {
        let all = &rows.columns;
        let model = all.columns(0, group.models).transpose();
        let size = layout.base * layout.columns;
        let cross = &mut self.cross.as_mut_slice()[section * size..(section + 1) * size];
        if group.columns.len() == layout.columns {
            let mut cross = DMatrixViewMut::from_slice(cross, layout.base, layout.columns);
            cross.gemm(1.0, &model, all, 1.0);
        } else {
            let product = model * all;
            for (column, own) in group.columns.iter().zip(product.column_iter()) {
                let to = &mut cross[column * layout.base..(column + 1) * layout.base];
                for (row, value) in group.columns.iter().zip(own.iter()) {
                    to[*row] += value;
                }
            }
        }
        let first = section * layout.squares;
        for live in &group.blocks {
            let place = &layout.places[live.block];
            let own = &mut self.own.as_mut_slice()[first + place.start..first + place.end];
            live.add(all, layout.blocks[live.block].len(), own);
        }
        let products = all.tr_mul(&rows.residual);
        let mut scores = self.scores.column_mut(section);
        for (column, product) in group.columns.iter().zip(products.iter()) {
            scores[*column] += product;
        }
    }

    /// Sums of the sections over cosines.
    pub(super) fn over(&self, waves: &DMatrix<f64>) -> Self {
        Self {
            cross: &self.cross * waves,
            own: &self.own * waves,
            scores: &self.scores * waves,
        }
    }
}

impl LiveBlock {
    /// Adds the products of the columns with each other to those of a block of `width` columns.
    fn add(&self, all: &DMatrix<f64>, width: usize, own: &mut [f64]) {
        if let [place] = *self.places {
            let inside = self.inside[0];
            own[inside * width + inside] += all.column(place).norm_squared();
            return;
        }
        let columns = all.select_columns(&self.places);
        let product = square(&columns);
        for (j, column) in self.inside.iter().zip(product.column_iter()) {
            for (i, value) in self.inside.iter().zip(column.iter()) {
                own[j * width + i] += value;
            }
        }
    }
}
