#include "sound/sources.h"

#include <charconv>

#include "sound/sound_file.h"
#include "vm_protocol/core/file_kind.h"

namespace sound {
namespace {

struct SourceName {
  std::string kind;
  std::string place;
  unsigned rate_hz = 16000;
};

/// "raw@44100:PATH"; false if the rate is none.
bool Parse(const std::string& name, SourceName& parsed) {
  const std::size_t colon = name.find(':');
  parsed.kind = name.substr(0, colon);
  parsed.place = colon == std::string::npos ? "" : name.substr(colon + 1);
  const std::size_t at = parsed.kind.find('@');
  if (at == std::string::npos) return true;
  const char* end = parsed.kind.data() + parsed.kind.size();
  const auto [rest, error] = std::from_chars(parsed.kind.data() + at + 1, end, parsed.rate_hz);
  const bool good =
      error == std::errc() && rest == end && parsed.rate_hz >= 1000 && parsed.rate_hz <= 400'000;
  parsed.kind.resize(at);
  return good;
}

}  // namespace

vm::Result<std::unique_ptr<AudioSource>> OpenSource(const std::string& name,
                                                    vm::Scheduler& scheduler,
                                                    boost::asio::io_context& io, bool real) {
  SourceName source;
  const bool good = Parse(name, source);
  const bool stream = source.kind == "raw" || source.kind == "tcp" || source.kind == "unix";
  const bool microphone = source.kind == "portaudio";
  if (!good || (source.place.empty() && !microphone) ||
      !(stream || microphone || source.kind == "wav")) {
    return vm::Fail(vm::Errc::kBadValue,
                    "found '" + name +
                        "', expected NONE, wav:PATH, raw[@RATE]:PATH, tcp[@RATE]:PORT, "
                        "unix[@RATE]:PATH or portaudio[:DEVICE]");
  }
  if (source.kind == "wav") {
    if (auto fit = vm::CheckReadable(source.place); !fit) return std::unexpected(fit.error());
    auto samples = ReadSound(source.place);
    if (!samples) return std::unexpected(samples.error());
    return std::make_unique<RecordedSource>(scheduler, std::move(*samples));
  }
  if (!real) {
    return vm::Fail(vm::Errc::kUnavailable, "'" + name + "' needs the real clock (--clock real)");
  }
  if (microphone) return OpenMicrophone(source.place, scheduler);
  return OpenStream(source.kind, source.place, source.rate_hz, io);
}

}  // namespace sound
