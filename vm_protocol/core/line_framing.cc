#include "vm_protocol/core/line_framing.h"

namespace vm {
namespace {

Error TooLong() {
  return {
      Errc::kTooLong,
      "line of more than " + std::to_string(kMaxLineBytes) + " bytes, the rest of it is skipped",
      0};
}

}  // namespace

void LineReader::Feed(std::string_view bytes, const OnLine& on_line) {
  while (!bytes.empty()) {
    const std::size_t newline = bytes.find('\n');
    const std::string_view piece = bytes.substr(0, newline);
    const bool complete = newline != std::string_view::npos;
    bytes.remove_prefix(complete ? newline + 1 : bytes.size());
    if (skipping_) {
      skipping_ = !complete;
      continue;
    }
    // One byte more than the limit is let through for a CR that does not count.
    if (partial_.size() + piece.size() > kMaxLineBytes + 1) {
      partial_.clear();
      joined_.clear();
      skipping_ = !complete;
      on_line(std::unexpected(TooLong()));
      continue;
    }
    if (complete && partial_.empty()) {
      Line(piece, on_line);  // the common case: no copy
      continue;
    }
    partial_ += piece;
    if (!complete) continue;
    std::string line;
    line.swap(partial_);
    Line(line, on_line);
  }
}

void LineReader::End(const OnLine& on_line) {
  std::string line;
  line.swap(partial_);
  skipping_ = false;
  if (!line.empty()) Line(line, on_line);
  if (!joined_.empty()) {
    line.clear();
    line.swap(joined_);
    on_line(std::string_view(line));
  }
}

void LineReader::Line(std::string_view line, const OnLine& on_line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  if (line.size() > kMaxLineBytes) {
    on_line(std::unexpected(TooLong()));
    return;
  }
  const bool ends_message = line.ends_with("./");
  if (framing_ == Framing::kAuto) framing_ = ends_message ? Framing::kMmi : Framing::kLf;
  if (framing_ == Framing::kLf) {
    on_line(line);
    return;
  }
  if (ends_message) line.remove_suffix(2);
  if (joined_.size() + line.size() > kMaxLineBytes) {
    joined_.clear();
    on_line(std::unexpected(TooLong()));
    return;
  }
  if (!joined_.empty()) joined_ += ' ';
  joined_ += line;
  if (!ends_message) return;
  std::string whole;
  whole.swap(joined_);
  on_line(std::string_view(whole));
}

std::string Frame(std::string_view line, Framing framing) {
  std::string framed(line);
  framed += framing == Framing::kMmi ? "./\n" : "\n";
  return framed;
}

}  // namespace vm
