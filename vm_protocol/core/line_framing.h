#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "vm_protocol/core/limits.h"
#include "vm_protocol/core/result.h"

namespace vm {

/// How lines are told apart on a stream.
enum class Framing {
  kLf,    ///< LF, or CR LF
  kMmi,   ///< "./" LF, the original's socket mode; lines without "./" are joined to the next by a
          ///< blank
  kAuto,  ///< kLf, becoming kMmi for good if the first line ends in "./"
};

/// Splits a byte stream into protocol lines. Pure: performs no I/O.
/// Limits:  kMaxLineBytes per line, terminator excluded. An overlong line is reported once, as
///          kTooLong, when its limit is passed; its rest is skipped and the next line is read well.
/// Lifetime: the view given to the callback is valid during the call only.
class LineReader {
 public:
  using OnLine = std::function<void(Result<std::string_view> line)>;
  explicit LineReader(Framing framing = Framing::kLf) : framing_(framing) {}

  void Feed(std::string_view bytes, const OnLine& on_line);
  /// A last line without its terminator counts as a line.
  void End(const OnLine& on_line);
  /// kAuto until it is known.
  Framing framing() const { return framing_; }

 private:
  void Line(std::string_view line, const OnLine& on_line);
  Framing framing_;
  std::string partial_;  // the line being read
  std::string joined_;   // kMmi: earlier lines of the message being read
  bool skipping_ = false;
};

/// The line with its terminator. (kAuto counts as kLf.)
std::string Frame(std::string_view line, Framing framing);

}  // namespace vm
