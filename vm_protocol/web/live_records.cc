#include "vm_protocol/web/live_records.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

namespace vm {
namespace {

constexpr double kMaxMs = 1e12;  // as in all lines
constexpr unsigned kMinRateHz = 8000, kMaxRateHz = 192000;
static_assert(std::endian::native == std::endian::little, "the wire is little-endian");

template <typename Number>
std::optional<Number> NumberOf(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

std::string_view NextWord(std::string_view& text) {
  const std::size_t end = std::min(text.find(' '), text.size());
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return word;
}

struct Head {
  LivePiece piece;
  std::size_t bytes = 0;  // that follow
};

std::optional<Head> ParseHead(std::string_view line, std::size_t max_bytes) {
  Head head;
  const std::string_view kind = NextWord(line);
  const auto ms = NumberOf<double>(NextWord(line));
  if (!ms || !std::isfinite(*ms) || std::abs(*ms) > kMaxMs) return std::nullopt;
  head.piece.at = Time(std::llround(*ms * 1000));
  head.piece.kind = LivePiece::Kind::kSilence;
  if (kind == "end" && line.empty()) return head;
  if (kind == "sound") {
    const auto rate = NumberOf<std::uint32_t>(NextWord(line));
    if (!rate || *rate < kMinRateHz || *rate > kMaxRateHz) return std::nullopt;
    head.piece.kind = LivePiece::Kind::kSound;
    head.piece.rate_hz = *rate;
  } else if (kind == "picture") {
    head.piece.kind = LivePiece::Kind::kPicture;
  } else {
    return std::nullopt;
  }
  const auto bytes = NumberOf<std::size_t>(NextWord(line));
  if (!bytes || *bytes > max_bytes || !line.empty()) return std::nullopt;
  if (kind == "sound" && *bytes % 2 != 0) return std::nullopt;
  head.bytes = *bytes;
  return head;
}

}  // namespace

Result<std::optional<LivePiece>> LiveRecords::Next() {
  const std::string_view rest = std::string_view(come_).substr(taken_);
  const std::size_t line = rest.substr(0, kMaxHeadBytes).find('\n');
  if (line == std::string_view::npos && rest.size() >= kMaxHeadBytes)
    return Fail(Errc::kTooLong, who_ + " sent a record whose head has no end");
  std::optional<Head> head;
  if (line != std::string_view::npos) {
    head = ParseHead(rest.substr(0, line), max_bytes_);
    if (!head) {
      return Fail(Errc::kSyntax, who_ + " sent '" + std::string(rest.substr(0, line)) +
                                     "', expected " + expected_);
    }
  }
  if (!head || rest.size() - line - 1 < head->bytes) {  // more must come
    come_.erase(0, taken_);
    taken_ = 0;
    return std::nullopt;
  }
  head->piece.bytes = rest.substr(line + 1, head->bytes);
  taken_ += line + 1 + head->bytes;
  return std::move(head->piece);
}

std::string LiveHeader(LivePiece::Kind kind, std::uint32_t number, double ms) {
  std::string header(16, '\0');
  header[0] = static_cast<char>(kind);
  std::memcpy(&header[4], &number, sizeof number);
  std::memcpy(&header[8], &ms, sizeof ms);
  return header;
}

}  // namespace vm
