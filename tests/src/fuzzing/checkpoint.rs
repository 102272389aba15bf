//! Checkpoints.

use super::bytes::Bytes;
use crate::checkpoints::{file, repair};
use meniscus::checkpoint::Checkpoint;
use meniscus::files::state::State;

/// Any bytes; the same with lengths and checksums made right, so that what is inside is looked at; and a file made of
/// them. What is refused is so in one line; what is accepted encodes to the same bytes.
pub fn checkpoint(data: &[u8]) {
    check(data);
    let mut repaired = data.to_vec();
    repair(&mut repaired);
    check(&repaired);
    check(&composed(data));
}

fn check(bytes: &[u8]) {
    match Checkpoint::decode(bytes) {
        Ok(checkpoint) => {
            assert_eq!(checkpoint.encode(), bytes);
            assert_eq!(checkpoint.encoded_length(), bytes.len() as u64);
            let state = State::from_bytes(&checkpoint.state);
            assert_eq!(state.as_ref().map(|state| state.positions.len()), Ok(checkpoint.crossings.len()));
            assert_eq!(state.map(|state| state.step), Ok(checkpoint.step()));
        }
        Err(error) => {
            let message = error.to_string();
            assert!(!message.is_empty() && !message.contains('\n'), "{message}");
        }
    }
}

/// A file of the right sections whose contents are parts of `data`, each as long as a number in it says.
fn composed(data: &[u8]) -> Vec<u8> {
    let mut bytes = Bytes(data);
    let lengths = [(); 3].map(|()| usize::from(bytes.byte()));
    let mut rest = bytes.0;
    let [configuration, state, crossings] = lengths.map(|length| {
        let (part, after) = rest.split_at(length.min(rest.len()));
        rest = after;
        part
    });
    let sections =
        [(b"CONF", configuration), (b"STAT", state), (b"CROS", crossings), (b"PROG", rest), (b"END.", b"")];
    file(1, &sections.map(|(tag, contents)| (*tag, contents)))
}
