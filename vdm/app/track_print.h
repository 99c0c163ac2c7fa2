#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "vdm/net/mouth_net.h"
#include "vdm/triphone/triphone_model.h"

namespace vdm {

/// The mouth of a whole sound, 16 kHz mono. `format`:
///   csv    a line of names, then a line each hop: ms, sound, opening_mm, seal, tongue, m1 .. m17
///          (mouth parameters at full articulation)
///   lines  what a face is told, to be piped into fsm; its time 0 is when the first line is read
/// REQUIRES: one of the two.
std::string PrintTrack(const MouthNet& net, std::span<const std::int16_t> samples,
                       const std::string& format);
/// The mouth of spoken phonemes, by triphones. Error: kLimit (MouthOf).
vm::Result<std::string> PrintTrack(const TriphoneModel& model, const vm::PhonemeList& phonemes,
                                   const std::string& format);

}  // namespace vdm
