#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "task_manager/grammar/compiler.h"

namespace vxml::srgs {

/// The built-in types of VoiceXML 2.0 appendix P: boolean, date, digits, currency, number, phone,
/// time; spoken in English and Japanese, and by keys. Their rules are the tables in builtin/*.abnf.
bool IsBuiltinType(const std::string& type);
/// True for en, en-US, ja, ja-JP, ... and for no language at all (taken as English).
bool HasBuiltinLanguage(const std::string& language);

/// "digits?minlength=3;maxlength=5" -> type and parameters.
struct BuiltinName {
  std::string type;
  std::map<std::string, std::string> parameters;
};
BuiltinName ParseBuiltin(const std::string& text);

/// Errors: kBadValue (parameters that contradict each other or are no numbers), kUnavailable (no
/// such type or language).
vm::Result<std::unique_ptr<Grammar>> MakeBuiltin(const BuiltinName& name, Mode mode,
                                                 const std::string& language);

}  // namespace vxml::srgs
