#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "vm_protocol/core/result.h"
#include "vm_protocol/core/scheduler.h"

namespace vm {

/// A picture of the face or a piece of what the voice says (docs/face.md, Pictures for other
/// programs; docs/speech.md, Sound for other programs).
struct LivePiece {
  enum class Kind : std::uint8_t { kPicture = 1, kSound = 2, kSilence = 3 };
  Kind kind = Kind::kPicture;
  Time at{0};                 ///< of the picture or the first sample; from when on there is silence
  std::uint32_t rate_hz = 0;  ///< of sound
  std::string bytes{};        ///< JPEG; samples, 16 bit little-endian, one channel; empty
};

/// Takes a stream of records apart: "picture MS BYTES", "sound MS RATE BYTES" or "end MS", a line
/// end, and so many bytes. Pure. Limits: kMaxHeadBytes of a head, `max_bytes` of what follows it.
class LiveRecords {
 public:
  static constexpr std::size_t kMaxHeadBytes = 128;
  /// `who` sends them, and `expected` are the heads it may send: for sentences.
  LiveRecords(std::string who, std::string expected, std::size_t max_bytes)
      : who_(std::move(who)), expected_(std::move(expected)), max_bytes_(max_bytes) {}

  void Add(std::string_view bytes) { come_.append(bytes); }
  /// The next whole one, with the sender's time. Errors: kSyntax, kTooLong; nothing can be read
  /// after them.
  Result<std::optional<LivePiece>> Next();

 private:
  const std::string who_, expected_;
  const std::size_t max_bytes_;
  std::string come_;
  std::size_t taken_ = 0;  // bytes of it
};

/// What goes before a piece in a message of a WebSocket: its kind, three zeros, `number` (of sound
/// its rate), and a time in ms (64 bit float), little-endian: 16 bytes.
std::string LiveHeader(LivePiece::Kind kind, std::uint32_t number, double ms);

}  // namespace vm
