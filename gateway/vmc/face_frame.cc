#include "gateway/vmc/face_frame.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "embedded/gateway_face_arkit.h"
#include "embedded/gateway_vowels.h"
#include "embedded/gateway_vrm0.h"
#include "embedded/gateway_vrm1.h"
#include "gateway/face/mouth_numbers.h"
#include "vdm/net/word_lines.h"
#include "vm_protocol/core/utf8.h"

namespace gateway {
namespace {

constexpr std::array<std::string_view, 13> kFaceNumbers{
    "vowel_a",         "vowel_i",     "vowel_u",       "vowel_e",        "vowel_o",
    "blink_left",      "blink_right", "left_eye_down", "left_eye_right", "right_eye_down",
    "right_eye_right", "head_down",   "head_right"};
constexpr std::size_t kFirstUnit = kMouthNumbers.size() + kFaceNumbers.size();
constexpr float kMost = 1e6F;
/// What is as far apart as another: 9 degrees of jaw, 8 mm of the corners, 6 mm of protrusion.
constexpr std::array<float, 3> kVowelScales{9, 8, 6};
constexpr std::string_view kVowelLetters = "aiueo";

bool ReadNumber(std::string_view word, float& value) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() && std::abs(value) <= kMost;
}

/// "12L": where the unit's strength stands; nothing for what is no unit.
std::optional<std::size_t> UnitPlace(std::string_view word, std::size_t& number) {
  if (word.size() < 2 || (word.back() != 'L' && word.back() != 'R')) return {};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size() - 1, number);
  if (error != std::errc() || end != word.data() + word.size() - 1) return {};
  return 2 * number + (word.back() == 'L' ? 0u : 1u);
}

std::optional<std::size_t> NumberOf(std::string_view word) {
  if (const auto mouth = MouthNumberOf(word)) return mouth;
  const auto face = std::ranges::find(kFaceNumbers, word);
  if (face != kFaceNumbers.end()) {
    return kMouthNumbers.size() + static_cast<std::size_t>(face - kFaceNumbers.begin());
  }
  std::size_t unit = 0;
  const auto place = UnitPlace(word, unit);
  if (!place || unit >= FaceFrame::kUnits) return {};
  return kFirstUnit + *place;
}

}  // namespace

vm::Result<FaceFrame> ParseFaceFrame(std::string_view text) {
  FaceFrame frame;
  const auto wrong = [](std::string_view word, const std::string& expected) {
    return vm::Fail(vm::Errc::kBadValue, "'" + vm::ShownUtf8(vm::CutUtf8(word, 40)) + "' found, " +
                                             expected + " expected");
  };
  float ms = 0;
  std::vector<float*> numbers{&ms};
  for (float& value : frame.mouth) numbers.push_back(&value);
  for (float* value : {&frame.seal, &frame.tongue, &frame.head[0], &frame.head[1], &frame.head[2],
                       &frame.left_eye[0], &frame.left_eye[1], &frame.right_eye[0],
                       &frame.right_eye[1], &frame.left_lid, &frame.right_lid}) {
    numbers.push_back(value);
  }
  std::size_t count = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (word.empty()) continue;
    if (count == 0) {
      const auto at = vm::ParseMs(word);
      if (!at) return wrong(word, "a time in ms");
      frame.at = *at;
    } else if (count < numbers.size()) {
      if (!ReadNumber(word, *numbers[count])) return wrong(word, "a number");
    } else {
      const std::size_t colon = std::min(word.find(':'), word.size());
      std::size_t unit = 0;
      const auto place = UnitPlace(word.substr(0, colon), unit);
      float strength = 0;
      if (!place || !ReadNumber(word.substr(std::min(colon + 1, word.size())), strength)) {
        return wrong(word, "UNIT:STRENGTH as 12L:0.7");
      }
      if (unit < FaceFrame::kUnits) frame.units[*place] = strength;
    }
    ++count;
  }
  if (count < numbers.size()) {
    return vm::Fail(vm::Errc::kBadValue, std::to_string(count) + " numbers found, " +
                                             std::to_string(numbers.size()) + " expected");
  }
  return frame;
}

vm::Result<FaceWeights> FaceWeights::Read(std::string_view vowels, std::string_view vrm0,
                                          std::string_view vrm1, std::string_view arkit) {
  FaceWeights read;
  vdm::WordLines lines("vowels.txt", vowels);
  for (std::size_t i = 0; i < kVowelLetters.size(); ++i) {
    const auto words = lines.Line("vowel", 4);
    if (!words) return std::unexpected(words.error());
    if ((*words)[1] != kVowelLetters.substr(i, 1)) {
      return lines.Wrong("expected the vowels a, i, u, e, o in this order");
    }
    for (std::size_t n = 0; n < kVowelScales.size(); ++n) {
      const auto number = lines.Number((*words)[n + 2]);
      if (!number) return std::unexpected(number.error());
      read.vowels_[i][n] = *number / kVowelScales[n];
    }
  }
  const std::array<std::pair<const char*, std::string_view>, 3> tables{
      {{"vrm0.txt", vrm0}, {"vrm1.txt", vrm1}, {"face_arkit.txt", arkit}}};
  for (std::size_t i = 0; i < tables.size(); ++i) {
    auto sums = WeightSums::Read(tables[i].first, tables[i].second, NumberOf);
    if (!sums) return std::unexpected(sums.error());
    read.sums_[i] = std::move(*sums);
  }
  // PerfectSync has ARKit's names with a capital first letter.
  for (std::string& name : read.sums_.back().names) {
    if (name[0] >= 'a' && name[0] <= 'z') name[0] = static_cast<char>(name[0] - 'a' + 'A');
  }
  return read;
}

const FaceWeights& FaceWeights::Built() {
  static const FaceWeights built = [] {
    auto read = Read(embedded::gateway_vowels(), embedded::gateway_vrm0(), embedded::gateway_vrm1(),
                     embedded::gateway_face_arkit());
    if (!read) throw std::runtime_error(read.error().text);
    return std::move(*read);
  }();
  return built;
}

std::array<float, 5> FaceWeights::Vowels(const FaceFrame& frame) const {
  const Vowel mouth{frame.mouth[kJaw] / kVowelScales[0], frame.mouth[kCornerX] / kVowelScales[1],
                    frame.mouth[kUpperOuterZ] / kVowelScales[2]};
  // Least squares with a price for each share (the lasso, Tibshirani 1996), by coordinate descent:
  // five shares of three numbers are not determined without it, and o would be told as a and u. The
  // order begins with what lies between others; a hundred rounds settle to two digits.
  constexpr int kRounds = 100;
  constexpr float kPrice = 0.02F;
  constexpr std::array<std::size_t, 5> kOrder{4, 0, 2, 3, 1};
  std::array<float, 5> shares{};
  Vowel left = mouth;
  for (int round = 0; round < kRounds; ++round) {
    for (const std::size_t v : kOrder) {
      float along = 0, length = 0;
      for (std::size_t n = 0; n < left.size(); ++n) {
        along += vowels_[v][n] * left[n];
        length += vowels_[v][n] * vowels_[v][n];
      }
      const float next = std::clamp(shares[v] + (along - kPrice) / length, 0.0F, 1.0F);
      for (std::size_t n = 0; n < left.size(); ++n) left[n] -= (next - shares[v]) * vowels_[v][n];
      shares[v] = next;
    }
  }
  for (float& share : shares) share *= 1 - std::clamp(frame.seal, 0.0F, 1.0F);
  return shares;
}

std::vector<float> FaceWeights::Of(const FaceFrame& frame, VmcNames names) const {
  std::vector<float> numbers;
  for (const float value : MouthNumbers(frame.mouth, frame.seal, frame.tongue)) {
    numbers.push_back(value);
  }
  for (const float share : Vowels(frame)) numbers.push_back(share);
  for (const float value : {frame.left_lid, frame.right_lid, frame.left_eye[0], frame.left_eye[1],
                            frame.right_eye[0], frame.right_eye[1], frame.head[0], frame.head[1]}) {
    numbers.push_back(value);
  }
  numbers.insert(numbers.end(), frame.units.begin(), frame.units.end());
  return Sums(names).Of(numbers);
}

}  // namespace gateway
