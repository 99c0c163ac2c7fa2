#include "ssm/app/voices_config.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "ssm/engines/command_engine.h"
#include "ssm/engines/hts_engine.h"
#include "ssm/engines/http_engine.h"
#include "ssm/engines/open_jtalk_engine.h"
#include "vm_protocol/http/json_entry.h"

namespace ssm {
namespace {

using Json = nlohmann::json;
using Engine = std::unique_ptr<SpeechEngine>;

std::string At(const VoicesSetting& setting, const std::string& path) {
  return vm::PathBeside(setting.folder, path);
}

OpenJtalkOptions OpenJtalkKeys(vm::JsonEntry& entry, const VoicesSetting& setting) {
  OpenJtalkOptions options;
  options.name = entry.Text("name");
  options.female = entry.Flag("female", true);
  options.program = entry.Text("program", options.program.c_str());
  options.voice_file = At(setting, entry.Text("voice"));
  options.dictionary = At(setting, entry.Text("dictionary", options.dictionary.c_str()));
  options.limit = entry.Limit("limit_ms", options.limit);
  return options;
}

vm::Result<Engine> OpenJtalk(vm::JsonEntry& entry, const VoicesSetting& setting) {
  OpenJtalkOptions options = OpenJtalkKeys(entry, setting);
  if (auto good = entry.Check(); !good) return std::unexpected(good.error());
  return MakeOpenJtalkEngine(std::move(options));
}

vm::Result<Engine> Hts(vm::JsonEntry& entry, const VoicesSetting& setting) {
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

vm::Result<Engine> Command(vm::JsonEntry& entry, const VoicesSetting& setting) {
  CommandOptions options;
  options.name = entry.Text("name");
  options.language = entry.Text("language", "en");
  options.female = entry.Flag("female", false);
  options.argv = entry.Texts("argv");
  options.table_name = At(setting, entry.Text("phonemes", ""));
  options.limit = entry.Limit("limit_ms", options.limit);
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

vm::Result<Engine> Recorded(vm::JsonEntry& entry, const VoicesSetting& setting) {
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

vm::Result<Engine> Http(vm::JsonEntry& entry, const VoicesSetting& setting) {
  HttpVoiceOptions options;
  options.name = entry.Text("name");
  options.language = entry.Text("language", "en");
  options.female = entry.Flag("female", false);
  options.model = entry.Text("model");
  options.voice = entry.Text("voice");
  options.format = entry.Text("format", "wav");
  if (options.format != "wav" && options.format != "pcm" && options.format != "mp3") {
    entry.Bad("format", "wav, pcm or mp3");
  }
  options.rate_hz = entry.Number("rate_hz", options.rate_hz, 8000, 192'000);
  options.aligner = setting.aligner;
  auto server = vm::ReadServer(entry, setting.folder, "/audio/speech", "a voice");
  if (!server) return std::unexpected(server.error());
  options.server = std::move(*server);
  return MakeHttpEngine(std::move(options));
}

vm::Result<Engine> MakeVoice(const Json& json, std::size_t index, const VoicesSetting& setting) {
  const std::string where = "voice " + std::to_string(index + 1) +
                            (json.is_object() && json.contains("name") && json["name"].is_string()
                                 ? " '" + json["name"].get<std::string>() + "'"
                                 : "");
  if (!json.is_object()) return vm::Fail(vm::Errc::kBadValue, where + ": expected an object");
  vm::JsonEntry entry(json, where);
  const std::string kind = entry.Text("engine");
  vm::Result<Engine> engine =
      vm::Fail(vm::Errc::kBadValue, where + ": \"engine\" is '" + kind +
                                        "', expected open_jtalk, hts, http, command or recorded");
  if (kind == "open_jtalk") engine = OpenJtalk(entry, setting);
  if (kind == "hts") engine = Hts(entry, setting);
  if (kind == "http") engine = Http(entry, setting);
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
