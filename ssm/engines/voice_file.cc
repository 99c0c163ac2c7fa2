#include "ssm/engines/voice_file.h"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

namespace ssm {
namespace {

constexpr std::size_t kMaxHeadBytes = 64u << 10;
constexpr std::size_t kMaxHeaderLines = 1000;

/// "5804-25678", with commas between several: first and last byte after [DATA].
bool LiesWithin(std::string_view places, std::uint64_t size) {
  std::istringstream list{std::string(places)};
  for (std::string place; std::getline(list, place, ',');) {
    std::uint64_t first = 0, last = 0;
    const char* end = place.data() + place.size();
    const auto begin = std::from_chars(place.data(), end, first);
    if (begin.ec != std::errc{} || begin.ptr == end || *begin.ptr != '-') return false;
    const auto rest = std::from_chars(begin.ptr + 1, end, last);
    if (rest.ec != std::errc{} || rest.ptr != end || last < first || last >= size) return false;
  }
  return !places.empty();
}

}  // namespace

vm::Result<VoiceFileHead> ReadVoiceFileHead(const std::string& path) {
  const auto bad = [&path](const std::string& what) {
    return vm::Fail(vm::Errc::kBadValue, "voice file '" + path + "': " + what);
  };
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return vm::Fail(vm::Errc::kUnavailable,
                    "cannot read voice file '" + path + "': " + std::strerror(errno));
  }
  std::string head(kMaxHeadBytes, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  if (!head.starts_with("[GLOBAL]")) {
    return vm::Fail(vm::Errc::kBadValue,
                    "'" + path + "' is no voice file, expected it to begin [GLOBAL]");
  }
  constexpr std::string_view kData = "[DATA]\n";
  const std::size_t data = head.find(kData);
  if (data == std::string::npos) return bad("there is no [DATA] after its head");
  file.clear();
  file.seekg(0, std::ios::end);
  const auto size = static_cast<std::uint64_t>(file.tellg()) - (data + kData.size());

  VoiceFileHead voice;
  std::vector<std::pair<std::string, std::string>> places;
  bool in_places = false;
  std::size_t number = 0;
  std::istringstream lines(head.substr(0, data));
  for (std::string line; std::getline(lines, line);) {
    if (++number > kMaxHeaderLines) return bad("its head has more than 1000 lines");
    if (line.starts_with('[')) {
      in_places = line == "[POSITION]";
      continue;
    }
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos) {
      return bad("line " + std::to_string(number) + ": found '" + line.substr(0, 40) +
                 "', expected KEY:VALUE");
    }
    const std::string key = line.substr(0, colon), value = line.substr(colon + 1);
    if (!in_places) {
      voice.values[key] = value;
    } else if (!LiesWithin(value, size)) {
      return bad(key + " is at " + value.substr(0, 40) + ", but there are " + std::to_string(size) +
                 " bytes of data");
    } else {
      places.emplace_back(key, value);
    }
  }
  for (const char* key : {"HTS_VOICE_VERSION", "SAMPLING_FREQUENCY", "FRAME_PERIOD", "NUM_STATES",
                          "NUM_STREAMS", "STREAM_TYPE", "FULLCONTEXT_FORMAT"}) {
    if (!voice.values.contains(key)) return bad(std::string("there is no ") + key);
  }
  if (places.size() < 4) return bad("[POSITION] has not the duration's and the streams' places");
  return voice;
}

vm::Result<void> CheckVoicesFit(const VoiceFileHead& first, const VoiceFileHead& other,
                                const std::string& other_path) {
  for (const auto& [key, value] : first.values) {
    // GV_OFF_CONTEXT and OPTION are taken from the first voice; COMMENT is for people.
    const bool counts = key == "SAMPLING_FREQUENCY" || key == "FRAME_PERIOD" ||
                        key.starts_with("NUM_") || key == "STREAM_TYPE" ||
                        key.starts_with("FULLCONTEXT") || key.starts_with("VECTOR_LENGTH") ||
                        key.starts_with("IS_MSD") || key.starts_with("USE_GV");
    if (!counts) continue;
    const auto found = other.values.find(key);
    if (found == other.values.end() || found->second != value) {
      return vm::Fail(vm::Errc::kBadValue, "voice file '" + other_path + "': " + key + " is '" +
                                               (found == other.values.end() ? "" : found->second) +
                                               "', expected '" + value +
                                               "' as of the voice it is mixed with");
    }
  }
  return {};
}

}  // namespace ssm
