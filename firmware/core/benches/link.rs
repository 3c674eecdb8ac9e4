//! Time per frame of the codec and of the core's input, on this machine: `cargo bench --package zygote-core`.
#![expect(missing_docs, reason = "the macros write functions without any")]
#![expect(clippy::unwrap_used, reason = "a benchmark that fails has to stop")]

#[path = "../tests/a_board/mod.rs"]
mod a_board;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use std::time::{Duration, Instant};
use zygote_core::Core;
use zygote_protocol::{
    Command, Decoder, FrameKind, Header, Hello, Link, MAX_ENCODED, MAX_PAYLOAD, Micros, Request, encode,
};

const NOW: Micros = Micros(1_000);
const HEADER: Header = Header { kind: FrameKind::Data, session: 1, seq: 2, ack: 3 };

fn core() -> Core<16, 8, 8, 128> {
    Core::new(a_board::config(16, 8, 8), NOW, None)
}

fn frame(link: &mut Link) -> Vec<u8> {
    let mut out = [0; MAX_ENCODED];
    let length = link.poll_transmit(NOW, &mut out);
    out[..length].to_vec()
}

/// A host and a core in session.
fn pair() -> (Link, Core<16, 8, 8, 128>) {
    let (mut host, mut core) = (Link::new(NOW), core());
    host.send_hello(1, &Hello::ours()).unwrap();
    core.handle_bytes(NOW, &frame(&mut host));
    while core.poll_transmit(NOW, &mut [0; MAX_ENCODED]) > 0 {}
    host.open(1, NOW);
    (host, core)
}

fn codec(criterion: &mut Criterion) {
    let mut out = [0; MAX_ENCODED];
    for size in [0, 32, 120, MAX_PAYLOAD] {
        let payload: Vec<u8> = (0..size).map(|at| u8::try_from(at % 251).unwrap()).collect();
        let length = encode(HEADER, &payload, &mut out).unwrap();
        let wire = out[..length].to_vec();
        let mut group = criterion.benchmark_group(format!("payload of {size} bytes"));
        group.throughput(Throughput::Bytes(u64::try_from(length).unwrap()));
        group.bench_function("encode", |b| b.iter(|| encode(HEADER, black_box(&payload), &mut out)));
        let mut decoder = Decoder::new();
        group.bench_function("decode", |b| {
            b.iter(|| decoder.next(&mut black_box(wire.as_slice())).unwrap().is_ok());
        });
    }
}

fn input(criterion: &mut Criterion) {
    let (mut host, mut core) = pair();
    let mut id = 0_u16;
    criterion.bench_function("handle_bytes: a Status request, answered", |b| {
        b.iter_custom(|count| {
            let mut spent = Duration::ZERO;
            for _ in 0..count {
                id = id.wrapping_add(1);
                host.send(&Request { id, command: Command::Status }).unwrap();
                let bytes = frame(&mut host);
                let start = Instant::now();
                core.handle_bytes(NOW, black_box(&bytes));
                spent += start.elapsed();
                let mut out = [0; MAX_ENCODED];
                loop {
                    let length = core.poll_transmit(NOW, &mut out);
                    if length == 0 {
                        break;
                    }
                    while host.receive(NOW, &mut &out[..length], true).is_some() {}
                }
            }
            spent
        });
    });
    let noise: Vec<u8> =
        (0..MAX_ENCODED).map(|at| u8::try_from(1 + at * 31 % 251).unwrap()).chain([0]).collect();
    criterion.bench_function("handle_bytes: 254 bytes of noise", |b| {
        b.iter(|| core.handle_bytes(NOW, black_box(&noise)));
    });
}

criterion_group! { name = benches; config = Criterion::default().sample_size(30); targets = codec, input }
criterion_main!(benches);
