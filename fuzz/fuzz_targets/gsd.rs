#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| meniscus_tests::fuzzing::gsd(data));
