//! How long the parts of planning take on a fish of 4,000 panels: `cargo bench --package zygote-stacking`.
#![expect(missing_docs, reason = "the macros write functions without any")]
#![expect(clippy::unwrap_used, reason = "a benchmark that fails has to stop")]

use criterion::{Criterion, criterion_group, criterion_main};
use std::path::Path;
use zygote_stacking::{Model, Request, fold, plan};

fn request(piles: usize) -> Request {
    Request { piles, ..Request::default() }
}

fn planning(criterion: &mut Criterion) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/fish4000.txt");
    let model = Model::read(&path, None).unwrap();
    let in_four = plan(&model, &request(4)).unwrap();
    let bytes = fold::write(&in_four).unwrap();
    criterion.bench_function("read voxels, find neighbours", |b| b.iter(|| Model::read(&path, None)));
    criterion.bench_function("plan one pile: the strip", |b| b.iter(|| plan(&model, &request(1))));
    criterion.bench_function("plan four piles", |b| b.iter(|| plan(&model, &request(4))));
    criterion.bench_function("write the plan", |b| b.iter(|| fold::write(&in_four)));
    criterion.bench_function("check the plan's file", |b| b.iter(|| fold::check(&bytes)));
}

criterion_group! { name = benches; config = Criterion::default().sample_size(20); targets = planning }
criterion_main!(benches);
