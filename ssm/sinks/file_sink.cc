#include "ssm/sinks/file_sink.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace ssm {

FileSink::FileSink(vm::Scheduler& scheduler, const std::string& path)
    : ClockSink(scheduler), path_(path) {
  auto file = WavWriter::Open(path);
  if (!file) throw std::runtime_error(file.error().text);
  file_ = std::move(*file);
  file_->Flush();
}

AudioSink::Position FileSink::Stop() {
  const auto ready = playing()->Ready();
  const std::size_t heard = Where().frames;
  // The engine is many times faster than the clock; should it ever lag, the rest is silence.
  auto written = file_->Write(ready.first(std::min(heard, ready.size())));
  if (written && heard > ready.size()) written = file_->WriteSilence(heard - ready.size());
  file_->Flush();
  Position position = ClockSink::Stop();
  position.failed = !written;
  return position;
}

}  // namespace ssm
