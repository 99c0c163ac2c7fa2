#pragma once

#include <string>
#include <string_view>

#include "vdm/train/mouth_loss.h"
#include "vm_protocol/core/phonemes.h"
#include "vm_protocol/core/result.h"

namespace vdm {

/// What a mouth did in a recording: from a film, or of any other source.
struct RecordedTrack {
  double step_ms = 0;
  MouthTruth truth{};  ///< `sound` is left empty
};

/// Reads a table as `vdm FILE.wav` prints it: cells between commas, a first line that names the
/// columns ms, seal, tongue and m1 to m17 in any order among others, then a line an instant, with
/// the same step between them, 1 to 100 ms. At most 360,000 instants. Error: kBadValue
/// "NAME:LINE: ...".
vm::Result<RecordedTrack> ReadTrack(const std::string& name, std::string_view text);

/// The track at instants `step_ms` apart, straight lines between those it has.
MouthTruth Resampled(const RecordedTrack& track, double step_ms);

/// A recording to learn from: its phonemes (a file of `a[80] k[60]`, as align prints them) and its
/// track.
struct Recording {
  vm::PhonemeList phonemes{};
  RecordedTrack track{};
};

/// Reads the recordings of a list: in each line the file of the phonemes and that of the track,
/// relative to the list; `#` begins a comment. Errors: kBadValue naming the file and line,
/// kUnavailable.
vm::Result<std::vector<Recording>> ReadRecordings(const std::string& list);

}  // namespace vdm
