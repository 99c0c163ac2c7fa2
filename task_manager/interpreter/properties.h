#pragma once

#include <map>
#include <string>

#include "task_manager/interpreter/position.h"
#include "task_manager/platform/platform.h"

namespace vxml {

/// Looks properties up from the inside out: item, dialog, document, application root, what the
/// session was given, the platform's defaults (VoiceXML 2.0 section 6.3, 2.1; ours: emotionspeak,
/// attention). Thread: the session's.
class Properties {
 public:
  Properties(const Position& position, const std::map<std::string, std::string>& given)
      : position_(position), given_(given) {}

  /// "" for unknown ones. Outside of dialogs the search begins at `from`. Handlers act as if copied
  /// into the active item: its properties count, not those around them.
  std::string Get(const std::string& name, const vm::xml::Node* from = nullptr) const;
  bool Is(const std::string& name, std::string_view value,
          const vm::xml::Node* from = nullptr) const {
    return Get(name, from) == value;
  }
  /// Throws error.semantic if the property has a value that is no time.
  Millis Time(const std::string& name, Millis otherwise) const;
  /// Between `min` and `max`; what is no number is `otherwise`.
  double Number(const std::string& name, double min, double max, double otherwise) const;

 private:
  const Position& position_;
  const std::map<std::string, std::string>& given_;
};

/// What the platform's own handlers say (VoiceXML 2.0 section 5.2.5), by language.
std::string DefaultMessage(const std::string& key, const std::string& language);

}  // namespace vxml
