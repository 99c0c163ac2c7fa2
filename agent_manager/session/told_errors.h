#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <string_view>

namespace am {

/// The errors that the console has been answered of late, so that a person who sees both streams
/// does not read them again in what the module says on stderr. Pure.
/// Limits: the last kMost.
class ToldErrors {
 public:
  static constexpr std::size_t kMost = 50;
  /// A line to the console: "From @FSM rep FaceExp.error = BAD_VALUE ..." is an error, most are
  /// not.
  void Told(std::string_view line);
  /// Whether a line of stderr complains of a line from outside: "error: TEXT (in: LINE)".
  static bool IsComplaint(std::string_view output);
  /// Whether such a line says what has been told; each telling counts once.
  bool Take(std::string_view output);

 private:
  std::deque<std::string> errors_;
};

}  // namespace am
