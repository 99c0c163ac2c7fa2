// The ear's three forms of grammars: parsed, matched against a piece of the input, and written for
// the engine where that is built.
#include <cstddef>
#include <cstdint>
#include <string>

#include "ear/grammar/grammar.h"
#ifdef GALATEA_HAS_SRM
#include "srm/grammar/jsgf_output.h"
#endif

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  for (const auto& grammar :
       {ear::ParseGrammar(text), ear::ParseJsgf("#JSGF V1.0;\ngrammar g;\n" + text)}) {
    if (!grammar) continue;
    static_cast<void>(grammar->Words());
    // What may be said is most often near the beginning; signs between words do not count.
    for (const std::size_t length : {std::size_t{6}, std::size_t{60}, size}) {
      static_cast<void>(grammar->Match(text.substr(0, length)));
    }
#ifdef GALATEA_HAS_SRM
    static_cast<void>(srm::ToJsgf({&*grammar}));
#endif
  }
  return 0;
}
