#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ssm/voice/span_builder.h"
#include "ssm/voice/speech_engine.h"
#include "vm_protocol/xml/node.h"

namespace ssm {

/// The longest pause and <prosody duration>.
inline constexpr Millis kLongestAsked{60'000};

/// A word of the standard and the number this implementation gives it.
struct NamedValue {
  std::string_view name;
  double value;
};
std::span<const NamedValue> RateNames();
std::span<const NamedValue> PitchNames();
std::span<const NamedValue> RangeNames();
std::span<const NamedValue> VolumeNames();
std::span<const NamedValue> BreakNames();  ///< ms
std::optional<double> Lookup(std::span<const NamedValue> table, std::string_view name);

struct Quantity {
  double number = 0;
  std::string unit{};
  bool relative = false;  ///< written with a sign
};
std::optional<Quantity> ReadQuantity(std::string_view text);

/// "120%" and "1.2" are factors, "+20%" is added to one.
std::optional<double> RateFactor(const Quantity& rate);
/// 0 to 100 (SSML 1.0), changes of that, percent, dB.
std::optional<double> VolumeFactor(const Quantity& volume);
/// As RateFactor, and semitones.
std::optional<double> PitchFactor(const Quantity& pitch);
/// "(0%,+20Hz) (50%,+10%)"; none if it is not written so or has more than 100 targets.
std::optional<std::vector<Intonation::Target>> ReadContour(std::string_view text);

/// Reads the attributes of elements. What cannot be read, and what is beyond a limit and therefore
/// taken to it, is told as a note of the text, once for the same words.
class ValueReader {
 public:
  /// `builder` gets the notes and outlives this.
  explicit ValueReader(SpanBuilder& builder) : builder_(builder) {}

  void Note(const std::string& what) { builder_.Note("SSML: " + what); }
  void NoteUnknown(const vm::xml::Node& element, const char* attribute);
  void NoteLimit(const vm::xml::Node& element, const char* attribute, const std::string& limit);

  using Convert = std::optional<double> (*)(const Quantity&);
  /// A factor: by its name in the table, else from a number with a unit; 1 where it is not there
  /// or cannot be read.
  double Factor(const vm::xml::Node& element, const char* attribute,
                std::span<const NamedValue> names, Convert convert, double least, double most);
  /// A number without a unit.
  std::optional<double> Count(const vm::xml::Node& element, const char* attribute, double most);
  /// "1.5s", "300ms"; from 0 to `most`.
  std::optional<Millis> Time(const vm::xml::Node& element, const char* attribute, Millis most);

 private:
  SpanBuilder& builder_;
};

}  // namespace ssm
