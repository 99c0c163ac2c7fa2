#include "task_manager/interpreter/properties.h"

#include <string_view>

namespace vxml {
namespace {

struct Property {
  std::string_view name;
  std::string_view value;
};

constexpr Property kDefaults[] = {
    {"confidencelevel", "0.5"},
    {"sensitivity", "0.5"},
    {"speedvsaccuracy", "0.5"},
    {"completetimeout", "500ms"},
    {"incompletetimeout", "1s"},
    {"maxspeechtimeout", "20s"},
    {"interdigittimeout", "3s"},
    {"termtimeout", "0s"},
    {"termchar", "#"},
    {"bargein", "true"},
    {"bargeintype", "speech"},
    {"timeout", "5s"},
    {"audiofetchhint", "prefetch"},
    {"audiomaxage", ""},
    {"audiomaxstale", ""},
    {"documentfetchhint", "safe"},
    {"documentmaxage", ""},
    {"documentmaxstale", ""},
    {"grammarfetchhint", "prefetch"},
    {"grammarmaxage", ""},
    {"grammarmaxstale", ""},
    {"objectfetchhint", "prefetch"},
    {"objectmaxage", ""},
    {"objectmaxstale", ""},
    {"scriptfetchhint", "prefetch"},
    {"scriptmaxage", ""},
    {"scriptmaxstale", ""},
    {"datafetchhint", "prefetch"},
    {"datamaxage", ""},
    {"datamaxstale", ""},
    {"fetchaudio", ""},
    {"fetchaudiodelay", "2s"},
    {"fetchaudiominimum", "5s"},
    {"fetchtimeout", "10s"},
    {"inputmodes", "dtmf voice"},
    {"universals", "none"},
    {"maxnbest", "1"},
    {"recordutterance", "false"},
    {"recordutterancetype", "audio/x-wav"},
    {"emotionspeak", "false"},
    {"attention", "true"},
};

struct Message {
  std::string_view key;
  std::string_view english;
  std::string_view japanese;
};

constexpr Message kMessages[] = {
    {"nomatch", "I did not understand. Please say that again.",
     "すみません、わかりませんでした。もう一度お願いします。"},
    {"maxspeechtimeout", "That was too long for me. Please say it in fewer words.",
     "長すぎました。短くお願いします。"},
    {"help", "I am sorry, there is no help for this question.",
     "すみません、この質問には説明がありません。"},
    {"error", "I am sorry, something went wrong. Goodbye.",
     "すみません、問題が起こりました。終了します。"},
    {"other", "I am sorry, I cannot go on. Goodbye.", "すみません、続けられません。終了します。"},
};

}  // namespace

std::string DefaultProperty(const std::string& name) {
  for (const Property& property : kDefaults) {
    if (property.name == name) return std::string(property.value);
  }
  return "";
}

std::string DefaultMessage(const std::string& key, const std::string& language) {
  for (const Message& message : kMessages) {
    if (message.key == key) {
      return std::string(language.starts_with("ja") ? message.japanese : message.english);
    }
  }
  return "";
}

}  // namespace vxml
