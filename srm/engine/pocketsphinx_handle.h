#pragma once

#include <pocketsphinx.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "srm/grammar/jsgf_output.h"
#include "vm_protocol/core/result.h"

/// Pocketsphinx as a value: shared by the decoder, the spotter and the aligner. Private to
/// srm/engine.
namespace srm {

struct DecoderDeleter {
  void operator()(ps_decoder_t* decoder) const { ps_free(decoder); }
};
using DecoderPtr = std::unique_ptr<ps_decoder_t, DecoderDeleter>;

/// A decoder with the model in a folder and more settings, name and value. Sound is taken as it is:
/// its own voice detector, noise reduction and second pass are off, so that scores can be compared
/// and times are those of the sound. Error: kUnavailable naming the folder.
vm::Result<DecoderPtr> OpenDecoder(
    const std::string& model, const std::vector<std::pair<std::string, std::string>>& settings);

/// Sets a grammar in JSGF under a name. As ps_set_jsgf_string, which never gives back what it
/// parsed: that adds up where grammars are switched. False if the decoder cannot take it.
bool SetJsgf(ps_decoder_t* decoder, const char* name, const std::string& text);

/// The phonemes as words of one phoneme each.
void AddPhonemeWords(ps_decoder_t* decoder);

/// A little noise over exact zeros, which the model's features cannot stand. Deterministic.
class Dither {
 public:
  /// `room`: the noise goes with the loudest of the last seconds, as its part of that. The model
  /// has learned from people in rooms; sound from a program or a telephone may have none between
  /// its words.
  explicit Dither(double room = 0) : room_(room) {}
  std::vector<std::int16_t> Add(std::span<const std::int16_t> samples);

 private:
  const double room_;
  double loudest_ = 0;
  std::uint32_t state_ = 1;
};

}  // namespace srm
