#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vxml {

/// True if the language tag (RFC 5646: en, en-US, zh-Hant-TW) names one of the given languages by
/// its first part; with no languages given, if it names any language of ISO 639-1.
bool IsSupported(std::string_view tag, const std::vector<std::string>& languages);

}  // namespace vxml
