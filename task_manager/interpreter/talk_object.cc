#include "task_manager/interpreter/talk_object.h"

#include <charconv>
#include <nlohmann/json.hpp>

#include "task_manager/document/values.h"

namespace vxml {
namespace {

constexpr int kMostTurns = 1000;
constexpr Millis kLongestSilence{600'000};
constexpr Millis kLongestTalk{3'600'000};
constexpr std::size_t kMostGoalBytes = 8192;
constexpr std::size_t kMostPhraseBytes = 2048;

std::string Expected(const std::string& name, const std::string& value, const std::string& what) {
  return "parameter " + name + " is '" + value.substr(0, 60) + "', expected " + what;
}

std::string SetTime(const std::string& name, const std::string& value, Millis longest,
                    Millis& time) {
  const auto read = ParseTime(value);
  if (!read || *read <= Millis(0) || *read > longest) {
    return Expected(name, value,
                    "a time such as 10s, up to " + std::to_string(longest.count() / 1000) + "s");
  }
  time = *read;
  return "";
}

std::string SetText(const std::string& name, const std::string& value, std::size_t most,
                    std::string& text) {
  if (value.size() > most) {
    return Expected(name, value, "at most " + std::to_string(most) + " bytes");
  }
  text = value;
  return "";
}

}  // namespace

std::string SetTalkParameter(const std::string& name, const std::string& value,
                             TalkRequest& request) {
  if (name == "goal") return SetText(name, value, kMostGoalBytes, request.goal);
  if (name == "end") return SetText(name, value, kMostPhraseBytes, request.end_phrases);
  if (name == "silence") return SetTime(name, value, kLongestSilence, request.silence);
  if (name == "maxtime") return SetTime(name, value, kLongestTalk, request.max_time);
  if (name != "turns") {
    return "there is no parameter '" + name + "', expected goal, end, turns, silence or maxtime";
  }
  int turns = 0;
  const char* const end = value.data() + value.size();
  const auto read = std::from_chars(value.data(), end, turns);
  if (read.ec != std::errc() || read.ptr != end || turns < 1 || turns > kMostTurns) {
    return Expected(name, value, "a number from 1 to " + std::to_string(kMostTurns));
  }
  request.turns = turns;
  return "";
}

script::Value ResultOfTalk(script::Engine& engine, const TalkResult& result) {
  auto words = nlohmann::json::array();
  for (const TalkResult::Words& said : result.words) {
    words.push_back({{"who", said.user ? "user" : "agent"}, {"text", said.text}});
  }
  const nlohmann::json all = {{"reason", result.reason},
                              {"turns", result.turns},
                              {"last", result.last},
                              {"result", result.result},
                              {"words", words}};
  return engine.Json(JsonText(all)).value_or(engine.Object());
}

}  // namespace vxml
