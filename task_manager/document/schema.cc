#include "task_manager/document/schema.h"

#include <algorithm>

namespace vxml {
namespace {

struct NameSet {
  std::string_view name;
  std::string_view members;
};

constexpr NameSet kSets[] = {
    {"@handlers", "catch help noinput nomatch error"},
    {"@audio", "audio enumerate value"},
    // SSML 1.0, and the face and voice markup of docs/dialogs.md.
    {"@speech",
     "audio enumerate value break desc emphasis lexicon lookup mark metadata meta p paragraph s "
     "sentence "
     "phoneme "
     "prosody say-as sub voice foreach emotion all-of media native head gaze gazeShift face "
     "faceFacs "
     "faceLexeme faceShift speech bml lang token w"},
    {"@exec",
     "audio enumerate value assign clear data disconnect exit foreach goto if log prompt reprompt "
     "return script submit throw var native mark break emotion emphasis prosody say-as sub voice p "
     "s sentence paragraph phoneme"},
};

constexpr std::string_view kFetch = " fetchaudio fetchhint fetchtimeout maxage maxstale";

constexpr ElementRule kElementRules[] = {
    {"vxml", "@handlers form link menu meta metadata property script var data",
     "version xmlns xml:base xml:lang application"},
    {"form",
     "@handlers block field filled grammar initial link object property record script subdialog "
     "transfer var data",
     "id scope"},
    {"menu", "@handlers @speech choice prompt property", "id scope dtmf accept", true},
    {"choice", "grammar @speech", "dtmf accept next expr event eventexpr message messageexpr",
     true},
    {"field", "@handlers @speech filled grammar link option prompt property",
     "name expr cond type slot modal", true},
    {"option", "", "dtmf accept value", true},
    {"initial", "@handlers @speech link prompt property grammar", "name expr cond", true},
    {"block", "@exec", "name expr cond", true},
    {"filled", "@exec", "mode namelist", true},
    {"catch", "@exec", "event count cond", true},
    {"help", "@exec", "count cond", true},
    {"noinput", "@exec", "count cond", true},
    {"nomatch", "@exec", "count cond", true},
    {"error", "@exec", "count cond", true},
    {"if", "@exec else elseif", "!cond", true},
    {"else", "", ""},
    {"elseif", "", "!cond"},
    {"foreach", "@exec @speech", "item array", true},
    {"prompt", "@speech", "bargein bargeintype cond count timeout xml:lang xml:base version", true},
    {"record", "@handlers @speech filled grammar prompt property",
     "name expr cond modal beep maxtime finalsilence dtmfterm type dest", true},
    {"transfer", "@handlers @speech filled grammar prompt property",
     "name expr cond dest destexpr bridge type typeexpr connecttimeout maxtime transferaudio aai "
     "aaiexpr",
     true},
    {"subdialog", "@handlers @speech filled param prompt property",
     "name expr cond src srcexpr namelist method enctype modal", true},
    {"object", "@handlers @speech filled param prompt property",
     "name expr cond classid codebase codetype data type archive", true},
    {"param", "", "!name expr value valuetype type"},
    {"link", "grammar", "next expr event eventexpr message messageexpr dtmf"},
    {"var", "", "name expr"},
    {"assign", "", "!name !expr"},
    {"clear", "", "namelist"},
    {"data", "", "name src srcexpr namelist method enctype"},
    {"disconnect", "", "namelist"},
    {"exit", "", "expr namelist"},
    {"goto", "", "next expr nextitem expritem"},
    {"submit", "", "next expr namelist method enctype"},
    {"return", "", "event eventexpr message messageexpr namelist"},
    {"throw", "", "event eventexpr message messageexpr"},
    {"reprompt", "", ""},
    {"log", "value", "label expr", true},
    {"script", "", "src srcexpr charset", true},
    {"property", "", "!name !value"},
    {"meta", "", "name content http-equiv scheme"},
    {"mark", "", "name nameexpr"},
    {"value", "", "!expr mode"},
    {"native", "value", "expr", true},
};

constexpr std::string_view kFetching = "goto submit subdialog link choice data script object";

const std::vector<AttributeChoice> kChoices = {
    {"goto", "next expr nextitem expritem", 1, 1},
    {"submit", "next expr", 1, 1},
    {"subdialog", "src srcexpr", 1, 1},
    {"choice", "next expr event eventexpr", 1, 1},
    {"choice", "message messageexpr", 0, 1},
    {"link", "next expr event eventexpr", 1, 1},
    {"link", "message messageexpr", 0, 1},
    {"throw", "event eventexpr", 1, 1},
    {"throw", "message messageexpr", 0, 1},
    {"return", "event eventexpr namelist", 0, 1},
    {"return", "message messageexpr", 0, 1},
    {"exit", "expr namelist", 0, 1},
    {"transfer", "dest destexpr", 0, 1},
    {"transfer", "aai aaiexpr", 0, 1},
    {"transfer", "bridge type typeexpr", 0, 1},
    {"param", "expr value", 1, 1},
    {"data", "src srcexpr", 1, 1},
    {"mark", "name nameexpr", 1, 1},
    {"var", "name", 1, 1},
    {"foreach", "array", 1, 1},
    {"foreach", "item", 1, 1},
};

}  // namespace

std::vector<std::string_view> SplitWords(std::string_view words) {
  std::vector<std::string_view> parts;
  constexpr std::string_view kBlanks = " \t\r\n";
  while (true) {
    const std::size_t begin = words.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return parts;
    const std::size_t end = std::min(words.find_first_of(kBlanks, begin), words.size());
    parts.push_back(words.substr(begin, end - begin));
    words.remove_prefix(end);
  }
}

bool HasWord(std::string_view list, std::string_view word) {
  const auto words = SplitWords(list);
  return std::ranges::find(words, word) != words.end();
}

const ElementRule* FindElementRule(std::string_view name) {
  for (const ElementRule& rule : kElementRules) {
    if (rule.name == name) return &rule;
  }
  return nullptr;
}

bool IsSpeechName(std::string_view name) {
  static const auto kNames = SplitWords(
      "speak audio break desc emphasis lang lexicon lookup mark meta metadata p s phoneme prosody "
      "say-as sub token voice w");
  return std::ranges::find(kNames, name) != kNames.end();
}

bool Allows(const ElementRule& rule, std::string_view child) {
  for (const std::string_view word : SplitWords(rule.children)) {
    if (word == child) return true;
    for (const NameSet& set : kSets) {
      if (set.name != word) continue;
      if (HasWord(set.members, child)) return true;
    }
  }
  return false;
}

const std::vector<AttributeChoice>& AttributeChoices() { return kChoices; }

/// True if the element knows the attribute (fetch attributes by the list of fetching elements).
bool KnowsAttribute(const ElementRule& rule, std::string_view name) {
  for (const std::string_view word : SplitWords(rule.attributes)) {
    if (word == name || (word.starts_with("!") && word.substr(1) == name)) return true;
  }
  const auto fetching = SplitWords(kFetching);
  if (std::find(fetching.begin(), fetching.end(), rule.name) == fetching.end()) return false;
  const auto fetch = SplitWords(kFetch);
  return std::find(fetch.begin(), fetch.end(), name) != fetch.end();
}

}  // namespace vxml
