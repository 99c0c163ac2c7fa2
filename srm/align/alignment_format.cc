#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "srm/align/phone_aligner.h"

namespace srm {
namespace {

using Json = nlohmann::json;

std::string AsJson(const Alignment& alignment) {
  Json json = {{"phonemes", Json::array()}, {"words", Json::array()}};
  for (const vm::Phoneme& phoneme : alignment.phonemes) {
    json["phonemes"].push_back({{"name", phoneme.name}, {"ms", phoneme.duration.count()}});
  }
  for (const HeardWord& word : alignment.words) {
    json["words"].push_back({{"text", word.text},
                             {"start", word.start.count()},
                             {"end", word.end.count()},
                             {"confidence", std::round(word.confidence * 1000) / 1000}});
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string AsTsv(const Alignment& alignment) {
  std::ostringstream text;
  Millis at{0};
  for (const vm::Phoneme& phoneme : alignment.phonemes) {
    const Millis end = at + phoneme.duration;
    text << at.count() << "\t" << end.count() << "\tphoneme\t" << phoneme.name << "\n";
    at = end;
  }
  for (const HeardWord& word : alignment.words) {
    text << word.start.count() << "\t" << word.end.count() << "\tword\t" << word.text << "\n";
  }
  return text.str();
}

struct Interval {
  Millis start, end;
  std::string text;
};

void Tier(std::ostringstream& text, int number, const char* name, Millis end,
          const std::vector<Interval>& intervals) {
  const auto seconds = [](Millis ms) { return static_cast<double>(ms.count()) / 1000; };
  text << "    item [" << number << "]:\n        class = \"IntervalTier\"\n        name = \""
       << name << "\"\n        xmin = 0\n        xmax = " << seconds(end)
       << "\n        intervals: size = " << intervals.size() << "\n";
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    text << "        intervals [" << i + 1
         << "]:\n            xmin = " << seconds(intervals[i].start)
         << "\n            xmax = " << seconds(intervals[i].end) << "\n            text = \""
         << intervals[i].text << "\"\n";
  }
}

/// Praat's text format: every tier covers the whole time without gaps.
std::string AsTextGrid(const Alignment& alignment) {
  std::vector<Interval> phonemes, words;
  Millis at{0};
  for (const vm::Phoneme& phoneme : alignment.phonemes) {
    phonemes.push_back({at, at + phoneme.duration, phoneme.name == "pau" ? "" : phoneme.name});
    at += phoneme.duration;
  }
  Millis covered{0};
  for (const HeardWord& word : alignment.words) {
    if (word.start > covered) words.push_back({covered, word.start, ""});
    words.push_back({word.start, word.end, word.text});
    covered = word.end;
  }
  if (covered < at) words.push_back({covered, at, ""});
  std::ostringstream text;
  text << "File type = \"ooTextFile\"\nObject class = \"TextGrid\"\n\nxmin = 0\nxmax = "
       << static_cast<double>(at.count()) / 1000 << "\ntiers? <exists>\nsize = 2\nitem []:\n";
  Tier(text, 1, "words", at, words);
  Tier(text, 2, "phonemes", at, phonemes);
  return text.str();
}

}  // namespace

vm::Result<std::string> FormatAlignment(const Alignment& alignment, const std::string& format) {
  if (format == "json") return AsJson(alignment);
  if (format == "pho") return vm::FormatPhonemesVoice(alignment.phonemes) + "\n";
  if (format == "tsv") return AsTsv(alignment);
  if (format == "textgrid") return AsTextGrid(alignment);
  return vm::Fail(vm::Errc::kBadValue,
                  "found '" + format + "', expected json, pho, tsv or textgrid");
}

}  // namespace srm
