#include "ssm/voice/phoneme_map.h"

#include <algorithm>
#include <sstream>
#include <utility>

namespace ssm {
namespace {

std::vector<std::string> Words(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(std::move(word));
  return words;
}

bool Contains(const std::vector<std::string>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string BadName(const std::string& name) { return "'" + name + "' is not in the set"; }

}  // namespace

vm::Result<PhonemeMap> PhonemeMap::Parse(std::string_view table, const std::string& file) {
  PhonemeMap map;
  std::istringstream lines{std::string(table)};
  std::size_t number = 0;
  const auto fail = [&](vm::Errc code, const std::string& what) {
    return vm::Fail(code, file + ":" + std::to_string(number) + ": " + what);
  };
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::vector<std::string> words = Words(line);
    if (words.empty() || words[0].starts_with('#')) continue;
    const bool mapping = words.size() >= 3 && words[1] == "=";
    const std::vector<std::string> rest(words.begin() + (mapping ? 2 : 1), words.end());
    if (!mapping && words[0] == "set" && !rest.empty()) {
      map.set_.insert(map.set_.end(), rest.begin(), rest.end());
    } else if (!mapping && words[0] == "vowels" && !rest.empty()) {
      map.vowels_.insert(map.vowels_.end(), rest.begin(), rest.end());
    } else if (!mapping && (words[0] == "pause" || words[0] == "double") && rest.size() == 1) {
      if (!map.InSet(rest[0])) return fail(vm::Errc::kBadValue, BadName(rest[0]));
      (words[0] == "pause" ? map.pause_ : map.double_) = rest[0];
    } else if (!mapping && words[0] == "doubled" && rest.size() == 2) {
      for (const std::string& name : rest) {
        if (!map.InSet(name)) return fail(vm::Errc::kBadValue, BadName(name));
      }
      map.doubled_[rest[0]] = rest[1];
    } else if (mapping) {
      for (const std::string& name : rest) {
        const bool joins = name.starts_with('+') && name.size() > 1;
        if (name == "-" || joins ? rest.size() > 1 : !map.InSet(name)) {
          return fail(vm::Errc::kBadValue, BadName(name));
        }
      }
      if (!map.names_.emplace(words[0], rest).second) {
        return fail(vm::Errc::kBadValue, "'" + words[0] + "' is there twice");
      }
    } else {
      return fail(vm::Errc::kSyntax, "found '" + line.substr(0, 40) +
                                         "', expected set, pause, double, vowels or NAME = ...");
    }
  }
  if (map.set_.empty()) return fail(vm::Errc::kSyntax, "there is no line 'set ...'");
  if (!map.InSet(map.pause_)) return fail(vm::Errc::kBadValue, BadName(map.pause_));
  if (!map.names_.contains("*")) return fail(vm::Errc::kSyntax, "there is no line '* = ...'");
  return map;
}

bool PhonemeMap::InSet(std::string_view name) const { return Contains(set_, name); }

const std::vector<std::string>& PhonemeMap::Find(std::string_view name) const {
  for (; !name.empty(); name.remove_suffix(1)) {
    if (const auto found = names_.find(name); found != names_.end()) return found->second;
  }
  return names_.find("*")->second;
}

void PhonemeMap::Add(vm::PhonemeList& list, const vm::Phoneme& phoneme) const {
  if (phoneme.duration.count() == 0) return;
  if (!list.empty() && list.back().name == phoneme.name) {
    if (phoneme.name == pause_) {
      list.back().duration += phoneme.duration;
      return;
    }
    if (const auto own = doubled_.find(phoneme.name); own != doubled_.end()) {
      list.back().name = own->second;
    } else if (!double_.empty() && !Contains(vowels_, phoneme.name)) {
      list.back().name = double_;
    }
  }
  list.push_back(phoneme);
}

vm::PhonemeList PhonemeMap::Map(const vm::PhonemeList& engine) const {
  vm::PhonemeList list;
  for (const vm::Phoneme& phoneme : engine) {
    if (phoneme.name.empty()) {
      Add(list, {pause_, phoneme.duration});
      continue;
    }
    const std::vector<std::string>& names = Find(phoneme.name);
    const bool joins = names[0].starts_with('+');
    if (joins || names[0] == "-") {
      if (list.empty()) {
        Add(list, {pause_, phoneme.duration});
        continue;
      }
      list.back().duration += phoneme.duration;
      const std::string joined = list.back().name + names[0].substr(1);
      if (joins && InSet(joined)) list.back().name = joined;
      continue;
    }
    const auto count = static_cast<std::int64_t>(names.size());
    auto left = phoneme.duration;
    for (std::int64_t i = 0; i < count; ++i) {
      const auto share = i + 1 == count ? left : phoneme.duration / count;
      left -= share;
      Add(list, {names[static_cast<std::size_t>(i)], share});
    }
  }
  return list;
}

}  // namespace ssm
