// The ear's three forms of grammars: parsed, matched against a piece of the input, and written for
// the engine.
#include <cstddef>
#include <cstdint>
#include <string>

#include "srm/grammar/grammar.h"
#include "srm/grammar/jsgf_output.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  for (const auto& grammar :
       {srm::ParseGrammar(text), srm::ParseJsgf("#JSGF V1.0;\ngrammar g;\n" + text)}) {
    if (!grammar) continue;
    static_cast<void>(grammar->Words());
    static_cast<void>(grammar->Match(text.substr(0, 60)));
    static_cast<void>(srm::ToJsgf({&*grammar}));
  }
  return 0;
}
