#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "vdm/net/mouth_net.h"
#include "vdm/prosody/head_net.h"
#include "vdm/recording/recorded_mouth.h"
#include "vdm/triphone/triphone_model.h"

namespace vdm {

/// What a track is made by; they outlive the call.
struct TrackNets {
  const MouthNet& mouth;
  const MouthNet* words = nullptr;  ///< heard beside `mouth`, or none
  const HeadNet* head = nullptr;    ///< or none
};

/// The mouth of a whole sound, 16 kHz mono. `format`:
///   csv    a line of names, then a line each hop: ms, sound, opening_mm, seal, tongue, m1 .. m17
///          (mouth parameters at full articulation)
///   lines  what a face is told, to be piped into fsm; its time 0 is when the first line is read
/// With a head there are also down, right and tilt in degrees, and the brow, 0 to 1.
///   prosody  a line each 10 ms: ms, hz (0: no voice), voicing, power_db, tilt_db, speech (how
///   likely),
///          syllable (1 where a nucleus has ended), pitch and power in deviations above the
///          speaker's usual, position in the phrase
/// `words`: what is known of the sound beside what the networks hear; may be empty.
/// REQUIRES: one of the three; a head that knows as many sounds as the mouth, or none.
std::string PrintTrack(const TrackNets& nets, const RecordedMouth& words,
                       std::span<const std::int16_t> samples, const std::string& format);
/// The mouth of spoken phonemes, by triphones. Error: kLimit (MouthOf).
vm::Result<std::string> PrintTrack(const TriphoneModel& model, const vm::PhonemeList& phonemes,
                                   const std::string& format);

}  // namespace vdm
