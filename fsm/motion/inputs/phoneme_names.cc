#include "fsm/motion/inputs/phoneme_names.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "fsm/base/table_reader.h"

namespace fsm {

std::string_view EngineNames::Ours(std::string_view name) const {
  if (const auto found = ours.find(name); found != ours.end()) return found->second;
  for (bool shorter = true; shorter;) {
    shorter = false;
    for (const std::string& ending : endings) {
      if (!name.ends_with(ending) || name.size() == ending.size()) continue;
      name.remove_suffix(ending.size());
      if (const auto found = ours.find(name); found != ours.end()) return found->second;
      shorter = true;
    }
  }
  return {};
}

namespace {

EngineNames ReadEngine(const TableRow& row) {
  if (row.size() != 3 || (row.Word(2) != "EN" && row.Word(2) != "JP")) {
    row.Refuse("engine NAME EN|JP expected");
  }
  const auto language = row.Word(2) == "EN" ? Language::kEnglish : Language::kJapanese;
  return {row.Word(1), language, {}, {}};
}

/// Reads pairs of an engine's name and ours, which must be in `known`.
void ReadPairs(const TableRow& row, const PhonemeTable& known, EngineNames& names) {
  if (row.size() % 2 != 0) row.Refuse("pairs of an engine's name and ours expected");
  for (std::size_t i = 0; i < row.size(); i += 2) {
    const std::string& ours = row.Word(i + 1);
    if (!known.contains(ours)) row.Refuse("'" + ours + "' is no phoneme of ours");
    if (!names.ours.emplace(row.Word(i), ours).second) {
      row.Refuse("the name '" + row.Word(i) + "' is here twice");
    }
  }
}

}  // namespace

vm::Result<std::vector<EngineNames>> ReadPhonemeNames(const std::string& name,
                                                      std::string_view text, const VisemeSet& set) {
  return ReadTable(name, text, [&set](const Table& table) {
    std::vector<EngineNames> engines;
    for (const TableRow& row : table.rows()) {
      if (row.key() == "engine") {
        engines.push_back(ReadEngine(row));
        continue;
      }
      if (engines.empty()) row.Refuse("engine NAME EN|JP expected first");
      EngineNames& names = engines.back();
      if (row.key() == "strip") {
        names.endings.assign(row.words().begin() + 1, row.words().end());
      } else {
        ReadPairs(row, set.PhonemesOf(names.language), names);
      }
    }
    return engines;
  });
}

std::string EngineList(const std::vector<EngineNames>& engines) {
  std::vector<std::string> list{"FLITE", "OPEN_JTALK"};
  for (const EngineNames& names : engines) {
    if (std::ranges::find(list, names.engine) == list.end()) list.push_back(names.engine);
  }
  return fmt::format("{}", fmt::join(list, " "));
}

VisemeFinder::VisemeFinder(const vm::PhonemeList& phonemes, const VisemeSet& set,
                           const std::vector<EngineNames>& engines, Language language,
                           std::string_view engine)
    : set_(set) {
  if (language != Language::kAuto) language_ = language;
  std::ptrdiff_t most = -1;
  const auto consider = [&](const EngineNames* names, Language theirs, std::string_view called) {
    if (language != Language::kAuto && language != theirs) return;
    if (!engine.empty() && engine != "AUTO" && engine != called) return;
    const auto known = std::ranges::count_if(phonemes, [&](const vm::Phoneme& phoneme) {
      return VisemesIn(names, theirs, phoneme.name) != nullptr;
    });
    if (known <= most) return;
    most = known;
    names_ = names;
    language_ = theirs;
  };
  consider(nullptr, Language::kJapanese, "OPEN_JTALK");
  consider(nullptr, Language::kEnglish, "FLITE");
  for (const EngineNames& names : engines) consider(&names, names.language, names.engine);
}

const PhonemeVisemes* VisemeFinder::VisemesIn(const EngineNames* names, Language language,
                                              std::string_view name) const {
  const std::string_view ours = names == nullptr ? name : names->Ours(name);
  const PhonemeTable& table = set_.PhonemesOf(language);
  const auto found = table.find(ours);
  return found == table.end() ? nullptr : &found->second;
}

const PhonemeVisemes* VisemeFinder::VisemesOf(std::string_view name) const {
  if (const PhonemeVisemes* visemes = VisemesIn(names_, language_, name)) return visemes;
  if (const PhonemeVisemes* visemes = VisemesIn(nullptr, language_, name)) return visemes;
  const bool english = language_ == Language::kEnglish;
  return VisemesIn(nullptr, english ? Language::kJapanese : Language::kEnglish, name);
}

}  // namespace fsm
