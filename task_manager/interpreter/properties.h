#pragma once

#include <string>

namespace vxml {

/// The platform's default of a property (VoiceXML 2.0 section 6.3, 2.1; ours: emotionspeak,
/// attention); "" for unknown ones.
std::string DefaultProperty(const std::string& name);

/// What the platform's own handlers say (VoiceXML 2.0 section 5.2.5), by language.
std::string DefaultMessage(const std::string& key, const std::string& language);

}  // namespace vxml
