#include "ssm/sinks/sink_choice.h"

#include <stdexcept>
#include <utility>

#include "ssm/sinks/file_sink.h"
#include "ssm/sinks/portaudio_sink.h"
#include "ssm/sinks/raw_sink.h"

namespace ssm {

vm::Result<SinkChoice> ParseSinkChoice(const std::string& text) {
  using Kind = SinkChoice::Kind;
  if (text == "auto") return SinkChoice{Kind::kAuto, {}};
  if (text == "null") return SinkChoice{Kind::kNull, {}};
  if (text == "portaudio") return SinkChoice{Kind::kPortAudio, {}};
  if (text.starts_with("portaudio:")) return SinkChoice{Kind::kPortAudio, text.substr(10)};
  if (text.starts_with("file:") && text.size() > 5) return SinkChoice{Kind::kFile, text.substr(5)};
  if (text.starts_with("raw:") && text.size() > 4) return SinkChoice{Kind::kRaw, text.substr(4)};
  return vm::Fail(vm::Errc::kBadValue, "found '" + text +
                                           "', expected auto, null, portaudio[:NAME], file:PATH or "
                                           "raw:PATH");
}

OpenedSink OpenSink(const SinkChoice& choice, vm::Scheduler& scheduler) {
  using Kind = SinkChoice::Kind;
  if (choice.kind == Kind::kFile) {
    return {std::make_unique<FileSink>(scheduler, choice.argument), {}};
  }
  if (choice.kind == Kind::kRaw) {
    return {std::make_unique<RawSink>(scheduler, choice.argument), {}};
  }
  if (choice.kind == Kind::kNull) return {std::make_unique<ClockSink>(scheduler), {}};
  auto sink = OpenPortAudio(scheduler, choice.argument);
  if (sink) return {std::move(*sink), {}};
  if (choice.kind == Kind::kPortAudio) throw std::runtime_error(sink.error().text);
  return {std::make_unique<ClockSink>(scheduler),
          sink.error().text + "; speaking silently, as with --sink null"};
}

}  // namespace ssm
