#include "ssm/app/voices_config.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "ssm/engines/command_engine.h"
#include "ssm/engines/hts_engine.h"
#include "ssm/engines/open_jtalk_engine.h"

namespace ssm {
namespace {

using Json = nlohmann::json;
using Engine = std::unique_ptr<SpeechEngine>;

/// One voice's object; remembers the first thing that is wrong with it.
class Entry {
 public:
  Entry(const Json& json, std::string where) : json_(json), where_(std::move(where)) {}

  std::string Text(const char* key, const char* otherwise = nullptr) {
    const auto found = Find(key);
    if (found == nullptr && otherwise != nullptr) return otherwise;
    if (found == nullptr || !found->is_string()) return Bad(key, "a text"), "";
    return found->get<std::string>();
  }
  bool Flag(const char* key, bool otherwise) {
    const auto found = Find(key);
    if (found == nullptr) return otherwise;
    if (!found->is_boolean()) return Bad(key, "true or false"), otherwise;
    return found->get<bool>();
  }
  Millis Limit(Millis otherwise) {
    const auto found = Find("limit_ms");
    if (found == nullptr) return otherwise;
    if (!found->is_number_integer() || *found < 1 || *found > 600'000) {
      return Bad("limit_ms", "a whole number from 1 to 600000"), otherwise;
    }
    return Millis(found->get<std::int64_t>());
  }
  std::vector<std::string> Texts(const char* key) {
    std::vector<std::string> texts;
    const auto found = Find(key);
    if (found == nullptr || !found->is_array() || found->empty()) return Bad(key, "a list"), texts;
    for (const Json& one : *found) {
      if (!one.is_string()) return Bad(key, "a list of texts"), texts;
      texts.push_back(one.get<std::string>());
    }
    return texts;
  }
  const Json* Find(const char* key) {
    known_.emplace_back(key);
    const auto found = json_.find(key);
    return found == json_.end() ? nullptr : &*found;
  }
  void Bad(const std::string& key, const std::string& expected) {
    if (error_.empty()) error_ = where_ + ": \"" + key + "\" must be " + expected;
  }
  vm::Result<void> Check() {
    for (const auto& [key, value] : json_.items()) {
      const bool known = std::find(known_.begin(), known_.end(), key) != known_.end();
      if (!known && error_.empty()) error_ = where_ + ": unknown key \"" + key + "\"";
    }
    if (error_.empty()) return {};
    return vm::Fail(vm::Errc::kBadValue, error_);
  }

 private:
  const Json& json_;
  const std::string where_;
  std::vector<std::string> known_;
  std::string error_;
};

std::string At(const VoicesSetting& setting, const std::string& path) {
  return path.empty() || path.starts_with('/') ? path : setting.folder + "/" + path;
}

OpenJtalkOptions OpenJtalkKeys(Entry& entry, const VoicesSetting& setting) {
  OpenJtalkOptions options;
  options.name = entry.Text("name");
  options.female = entry.Flag("female", true);
  options.program = entry.Text("program", options.program.c_str());
  options.voice_file = At(setting, entry.Text("voice"));
  options.dictionary = At(setting, entry.Text("dictionary", options.dictionary.c_str()));
  options.limit = entry.Limit(options.limit);
  return options;
}

vm::Result<Engine> OpenJtalk(Entry& entry, const VoicesSetting& setting) {
  OpenJtalkOptions options = OpenJtalkKeys(entry, setting);
  if (auto good = entry.Check(); !good) return std::unexpected(good.error());
  return MakeOpenJtalkEngine(std::move(options));
}

vm::Result<Engine> Hts(Entry& entry, const VoicesSetting& setting) {
  HtsOptions options{.analysis = OpenJtalkKeys(entry, setting)};
  if (const Json* emotions = entry.Find("emotions")) {
    const std::string expected =
        "{EMOTION: FILE, ...} with HAPPY, ANGRY, DISGUSTED, SAD, "
        "SURPRISED or FEARED";
    if (!emotions->is_object()) entry.Bad("emotions", expected);
    for (const auto& [emotion, file] : emotions->items()) {
      if (emotion == "NEUTRAL" || !MannerOf(emotion, 100) || !file.is_string()) {
        entry.Bad("emotions", expected + "; found \"" + emotion + "\"");
        break;
      }
      options.emotions[emotion] = At(setting, file.get<std::string>());
    }
  }
  if (auto good = entry.Check(); !good) return std::unexpected(good.error());
#ifdef SSM_HAS_HTS
  return MakeHtsEngine(std::move(options));
#else
  return vm::Fail(vm::Errc::kUnavailable, "this program was built without hts_engine");
#endif
}

vm::Result<Engine> Command(Entry& entry, const VoicesSetting& setting) {
  CommandOptions options;
  options.name = entry.Text("name");
  options.language = entry.Text("language", "en");
  options.female = entry.Flag("female", false);
  options.argv = entry.Texts("argv");
  options.table_name = At(setting, entry.Text("phonemes", ""));
  options.limit = entry.Limit(options.limit);
  options.aligner = setting.aligner;
  if (auto good = entry.Check(); !good) return std::unexpected(good.error());
  if (!options.table_name.empty()) {
    auto table = setting.read_file(options.table_name);
    if (!table) return std::unexpected(table.error());
    options.table = std::move(*table);
  }
  // A program beside the file, named with a slash.
  if (options.argv[0].find('/') != std::string::npos)
    options.argv[0] = At(setting, options.argv[0]);
  return MakeCommandEngine(std::move(options));
}

vm::Result<Engine> Recorded(Entry& entry, const VoicesSetting& setting) {
  RecordedOptions options;
  options.name = entry.Text("name");
  options.language = entry.Text("language", "en");
  options.female = entry.Flag("female", false);
  options.aligner = setting.aligner;
  const Json* list = entry.Find("recordings");
  if (list == nullptr || !list->is_array())
    entry.Bad("recordings", "a list");
  else {
    for (const Json& one : *list) {
      if (!one.is_object() || !one.contains("text") || !one.contains("wav") ||
          !one["text"].is_string() || !one["wav"].is_string()) {
        entry.Bad("recordings", "a list of {\"text\": ..., \"wav\": ...}");
        break;
      }
      options.recordings.push_back(
          {one["text"].get<std::string>(), At(setting, one["wav"].get<std::string>())});
    }
  }
  if (auto good = entry.Check(); !good) return std::unexpected(good.error());
  return MakeRecordedEngine(std::move(options));
}

vm::Result<Engine> MakeVoice(const Json& json, std::size_t index, const VoicesSetting& setting) {
  const std::string where = "voice " + std::to_string(index + 1) +
                            (json.is_object() && json.contains("name") && json["name"].is_string()
                                 ? " '" + json["name"].get<std::string>() + "'"
                                 : "");
  if (!json.is_object()) return vm::Fail(vm::Errc::kBadValue, where + ": expected an object");
  Entry entry(json, where);
  const std::string kind = entry.Text("engine");
  vm::Result<Engine> engine =
      vm::Fail(vm::Errc::kBadValue, where + ": \"engine\" is '" + kind +
                                        "', expected open_jtalk, hts, command or recorded");
  if (kind == "open_jtalk") engine = OpenJtalk(entry, setting);
  if (kind == "hts") engine = Hts(entry, setting);
  if (kind == "command") engine = Command(entry, setting);
  if (kind == "recorded") engine = Recorded(entry, setting);
  if (!engine && !engine.error().text.starts_with(where)) {
    return vm::Fail(engine.error().code, where + ": " + engine.error().text);
  }
  return engine;
}

}  // namespace

vm::Result<VoicesConfig> ParseVoicesConfig(std::string_view text, const VoicesSetting& setting) {
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::parse_error& error) {
    return vm::Fail(vm::Errc::kSyntax, "no JSON at byte " + std::to_string(error.byte));
  }
  if (!json.is_object()) return vm::Fail(vm::Errc::kBadValue, "expected {\"voices\": [...]}");
  VoicesConfig config;
  for (const auto& [key, value] : json.items()) {
    if (key == "voices" && value.is_array()) {
      for (std::size_t i = 0; i < value.size(); ++i) {
        auto engine = MakeVoice(value[i], i, setting);
        if (!engine) return std::unexpected(engine.error());
        config.engines.push_back(std::move(*engine));
      }
    } else if (key == "languages" && value.is_object()) {
      for (const auto& [language, voice] : value.items()) {
        if (!voice.is_string()) {
          return vm::Fail(vm::Errc::kBadValue,
                          "\"languages\": \"" + language + "\" must be a text");
        }
        config.languages[language] = voice.get<std::string>();
      }
    } else {
      return vm::Fail(vm::Errc::kBadValue,
                      "found \"" + key + "\", expected \"voices\": [...] or \"languages\": {...}");
    }
  }
  return config;
}

}  // namespace ssm
