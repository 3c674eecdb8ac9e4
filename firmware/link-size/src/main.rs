//! Every message of the protocol through a link, in both directions as an MCU uses them, with inputs that the compiler
//! cannot see: what is left after linking is what codec and link take. It never runs.
#![no_std]
#![no_main]

use core::hint::black_box;
use core::sync::atomic::AtomicU8;
use zygote_protocol::{
    Fault, HelloReply, Link, MAX_ENCODED, Micros, Received, Report, Request, Telemetry, Urgent, decode_payload,
    peek_request_id, peek_versions,
};

/// The RAM of one link.
static RAM: [AtomicU8; size_of::<Link>()] = [const { AtomicU8::new(0) }; size_of::<Link>()];

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}

/// A value that the compiler must take for possible.
fn any<T>() -> Option<T> {
    black_box(None)
}

/// What a board's core does with its link.
#[expect(unsafe_code, reason = "the linker finds the entry by its name")]
#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
    black_box(&RAM);
    let mut link = Link::new(Micros(0));
    let mut frame = [0; MAX_ENCODED];
    loop {
        let now = Micros(black_box(1));
        let mut bytes: &[u8] = black_box(&[]);
        while let Some(received) = link.receive_with_room(now, &mut bytes) {
            match received {
                Received::Hello(session, payload) => {
                    black_box(peek_versions(payload));
                    link.open(session, now);
                }
                Received::Message(payload) => {
                    black_box(decode_payload::<Request>(payload).ok_or(peek_request_id(payload))).ok();
                }
                Received::Urgent(payload) => drop(black_box(decode_payload::<Urgent>(payload))),
                Received::HelloReply(..) | Received::Telemetry(_) | Received::Reset => {}
            }
        }
        if let Some(reply) = any::<HelloReply>() {
            link.send_hello_reply(black_box(1), &reply).ok();
        }
        if let Some(report) = any::<Report>() {
            link.send(&report).ok();
        }
        if let Some(telemetry) = any::<Telemetry>() {
            link.send_telemetry(&telemetry).ok();
        }
        if let Some(fault) = any::<Fault>() {
            link.send_urgent(&fault).ok();
        }
        let length = link.poll_transmit(now, &mut frame);
        black_box((&frame, length, link.poll_timeout(now), link.counters()));
    }
}
