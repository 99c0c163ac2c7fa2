#include "task_manager/interpreter/properties.h"

#include <string_view>

#include "task_manager/document/values.h"

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

/// The platform's own value of a property, "" for unknown ones.
std::string DefaultOf(const std::string& name) {
  for (const Property& property : kDefaults) {
    if (property.name == name) return std::string(property.value);
  }
  return "";
}

}  // namespace

std::string Properties::Get(const std::string& name, const vm::xml::Node* from) const {
  const vm::xml::Node* node = position_.item     ? position_.item->node
                              : position_.dialog ? position_.dialog->node
                              : from             ? from
                                                 : &position_.Here();
  for (; node; node = node->parent) {
    for (const auto& document : {position_.document, position_.root}) {
      const std::string* value = document ? document->FindProperty(*node, name) : nullptr;
      if (value) return *value;
    }
  }
  if (position_.root) {
    const std::string* value = position_.root->FindProperty(*position_.root->root, name);
    if (value) return *value;
  }
  const auto given = given_.find(name);
  return given != given_.end() ? given->second : DefaultOf(name);
}

Millis Properties::Time(const std::string& name, Millis otherwise) const {
  const std::string text = Get(name);
  if (text.empty()) return otherwise;
  const auto time = ParseTime(text);
  if (!time) {
    position_.ThrowSemantic(position_.Here(),
                            "property " + name + " '" + text + "', expected a time as 5s or 300ms");
  }
  return *time;
}

double Properties::Number(const std::string& name, double min, double max, double otherwise) const {
  return NumberIn(Get(name), min, max, otherwise);
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
