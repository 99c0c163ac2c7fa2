#pragma once

#include <memory>
#include <string>

#include "ssm/voice/audio_sink.h"
#include "ssm/voice/wav_file.h"

namespace ssm {

/// A WAV file instead of a loudspeaker: what is heard of each utterance, one after the other,
/// without the time between (the Record slot keeps that). Takes as long as a loudspeaker would. The
/// file on disk is whole after every utterance.
class FileSink final : public ClockSink {
 public:
  /// Throws std::runtime_error if the file cannot be written.
  FileSink(vm::Scheduler& scheduler, const std::string& path);
  Position Stop() override;
  std::string name() const override { return "file:" + path_; }

 private:
  const std::string path_;
  std::unique_ptr<WavWriter> file_;
};

}  // namespace ssm
