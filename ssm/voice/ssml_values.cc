#include "ssm/voice/ssml_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace ssm {
namespace {

constexpr std::size_t kMaxTargets = 100;
constexpr std::size_t kMaxQuoted = 60;  // bytes of a value in a note

// The words of the standard; their values are left to the implementation.
constexpr std::array<NamedValue, 7> kRates = {{{"x-slow", 0.5},
                                               {"slow", 0.75},
                                               {"medium", 1},
                                               {"fast", 1.35},
                                               {"x-fast", 1.8},
                                               {"default", 1},
                                               {"", 1}}};
constexpr std::array<NamedValue, 7> kPitches = {{{"x-low", 0.7},
                                                 {"low", 0.85},
                                                 {"medium", 1},
                                                 {"high", 1.18},
                                                 {"x-high", 1.4},
                                                 {"default", 1},
                                                 {"", 1}}};
constexpr std::array<NamedValue, 7> kRanges = {{{"x-low", 0.4},
                                                {"low", 0.7},
                                                {"medium", 1},
                                                {"high", 1.4},
                                                {"x-high", 1.8},
                                                {"default", 1},
                                                {"", 1}}};
constexpr std::array<NamedValue, 8> kVolumes = {{{"silent", 0},
                                                 {"x-soft", 0.25},
                                                 {"soft", 0.5},
                                                 {"medium", 1},
                                                 {"loud", 1.6},
                                                 {"x-loud", 2.5},
                                                 {"default", 1},
                                                 {"", 1}}};
constexpr std::array<NamedValue, 6> kBreaks = {{{"none", 0},
                                                {"x-weak", 50},
                                                {"weak", 150},
                                                {"medium", 300},
                                                {"strong", 600},
                                                {"x-strong", 1000}}};

std::string Written(const vm::xml::Node& element, const char* attribute) {
  return "<" + element.name + " " + attribute + "=\"" +
         element.Get(attribute).substr(0, kMaxQuoted) + "\">";
}

/// 0.2 as "20%".
std::string Percent(double factor) { return std::to_string(std::lround(factor * 100)) + "%"; }

}  // namespace

std::span<const NamedValue> RateNames() { return kRates; }
std::span<const NamedValue> PitchNames() { return kPitches; }
std::span<const NamedValue> RangeNames() { return kRanges; }
std::span<const NamedValue> VolumeNames() { return kVolumes; }
std::span<const NamedValue> BreakNames() { return kBreaks; }

std::optional<double> Lookup(std::span<const NamedValue> table, std::string_view name) {
  const auto row = std::ranges::find(table, name, &NamedValue::name);
  return row == table.end() ? std::nullopt : std::optional(row->value);
}

std::optional<Quantity> ReadQuantity(std::string_view written) {
  const std::string text(vm::xml::Trim(written));
  char* rest = nullptr;
  const double number = std::strtod(text.c_str(), &rest);
  if (rest == text.c_str() || !std::isfinite(number)) return std::nullopt;
  return Quantity{number, std::string(vm::xml::Trim(rest)), text[0] == '+' || text[0] == '-'};
}

std::optional<double> RateFactor(const Quantity& rate) {
  if (rate.unit == "%") return rate.relative ? 1 + rate.number / 100 : rate.number / 100;
  if (rate.unit.empty() && !rate.relative) return rate.number;
  return std::nullopt;
}
std::optional<double> VolumeFactor(const Quantity& volume) {
  if (volume.unit == "dB") return std::pow(10, volume.number / 20);
  if (volume.unit != "%" && !volume.unit.empty()) return std::nullopt;
  return volume.relative ? 1 + volume.number / 100 : volume.number / 100;
}
std::optional<double> PitchFactor(const Quantity& pitch) {
  if (pitch.unit == "st") return std::pow(2, pitch.number / 12);
  return RateFactor(pitch);
}

std::optional<std::vector<Intonation::Target>> ReadContour(std::string_view text) {
  std::vector<Intonation::Target> contour;
  while (!vm::xml::IsBlank(text)) {
    text = vm::xml::Trim(text);
    const std::size_t comma = text.find(','), end = text.find(')');
    if (text[0] != '(' || end == text.npos || comma > end || contour.size() >= kMaxTargets) {
      return std::nullopt;
    }
    const auto place = ReadQuantity(text.substr(1, comma - 1));
    const auto pitch = ReadQuantity(text.substr(comma + 1, end - comma - 1));
    if (!place || place->unit != "%" || !pitch) return std::nullopt;
    Intonation::Target target{.at01 = std::clamp(place->number / 100, 0.0, 1.0)};
    if (pitch->unit == "Hz") {
      (pitch->relative ? target.shift_hz : target.hz) = pitch->number;
    } else if (const auto factor = PitchFactor(*pitch)) {
      target.factor = *factor;
    } else {
      return std::nullopt;
    }
    if (contour.empty() || target.at01 > contour.back().at01) contour.push_back(target);
    text.remove_prefix(end + 1);
  }
  return contour;
}

void ValueReader::NoteUnknown(const vm::xml::Node& element, const char* attribute) {
  Note(Written(element, attribute) + " is not understood");
}

void ValueReader::NoteLimit(const vm::xml::Node& element, const char* attribute,
                            const std::string& limit) {
  Note(Written(element, attribute) + " is beyond the limit, " + limit + " is taken");
}

double ValueReader::Factor(const vm::xml::Node& element, const char* attribute,
                           std::span<const NamedValue> names, Convert convert, double least,
                           double most) {
  const std::string text(vm::xml::Trim(element.Get(attribute)));
  if (text.empty()) return 1;
  auto value = Lookup(names, text);
  if (const auto quantity = ReadQuantity(text); !value && quantity) value = convert(*quantity);
  if (!value) NoteUnknown(element, attribute);
  const double factor = std::clamp(value.value_or(1), least, most);
  if (value && factor != *value) NoteLimit(element, attribute, Percent(factor));
  return factor;
}

std::optional<double> ValueReader::Count(const vm::xml::Node& element, const char* attribute,
                                         double most) {
  if (!element.Has(attribute)) return std::nullopt;
  const auto read = ReadQuantity(element.Get(attribute));
  if (!read || !read->unit.empty()) {
    NoteUnknown(element, attribute);
    return std::nullopt;
  }
  const double count = std::clamp(read->number, 0.0, most);
  if (count != read->number) NoteLimit(element, attribute, std::to_string(std::lround(count)));
  return count;
}

std::optional<Millis> ValueReader::Time(const vm::xml::Node& element, const char* attribute,
                                        Millis most) {
  if (!element.Has(attribute)) return std::nullopt;
  const auto read = ReadQuantity(element.Get(attribute));
  if (!read || (read->unit != "s" && read->unit != "ms")) {
    NoteUnknown(element, attribute);
    return std::nullopt;
  }
  const double ms = read->unit == "s" ? read->number * 1000 : read->number;
  const double taken = std::clamp(ms, 0.0, static_cast<double>(most.count()));
  if (taken != ms)
    NoteLimit(element, attribute, taken == 0 ? "0s" : std::to_string(most.count() / 1000) + "s");
  return Millis(std::lround(taken));
}

}  // namespace ssm
