#include "ear/grammar_shelf.h"

namespace ear {

void DeclareGrammarSlots(vm::SlotMachine& slots, const GrammarSlots& grammars) {
  slots.Declare({.name = "Grammar",
                 .grammar = "NONE | <word>...",
                 .initial = "NONE",
                 .auto_output = true,
                 .help = "The active grammars, by name; a match is sought in this order. " +
                         grammars.none_help,
                 .on_set = grammars.activate,
                 .saved = false});
  slots.Declare(
      {.name = "Grammar.load",
       .grammar = "<word> <text>",
       .access = vm::Access::kWriteOnly,
       .help =
           "NAME PHRASE | PHRASE ...: loads or replaces a grammar. A phrase has words, * for any "
           "word, [optional words], (one | other), x+, x<2-4>, /WEIGHT/ and {meaning}. Case and "
           "punctuation do not count. docs/speech.md has the whole form.",
       .on_set = [load = grammars.load](
                     const vm::SetValue& value) { return load(value.word(0), value.word(1)); },
       .saved = false});
  slots.Declare({.name = "Grammar.file",
                 .grammar = "<word> <file>",
                 .access = vm::Access::kWriteOnly,
                 .help = "NAME FILE: the same from a file: a phrase on each line and rules "
                         "$name = ..., or JSGF, or SRGS in XML; told by its first characters.",
                 .on_set = [read = grammars.read_file, load = grammars.load](
                               const vm::SetValue& value) -> vm::Result<std::string> {
                   auto text = read(value.word(1));
                   if (!text) return std::unexpected(text.error());
                   auto loaded = load(value.word(0), *text);
                   if (loaded) return loaded;
                   return vm::Fail(loaded.error().code, value.word(1) + ": " + loaded.error().text);
                 },
                 .saved = false});
  slots.Declare(
      {.name = "Grammar.drop",
       .grammar = "<word>",
       .access = vm::Access::kWriteOnly,
       .help = "Forgets a grammar; it is no longer active then.",
       .on_set = [drop = grammars.drop](const vm::SetValue& value) { return drop(value.word(0)); },
       .saved = false});
  slots.Declare({.name = "Grammar.set",
                 .grammar = "<text>",
                 .access = vm::Access::kReadOnly,
                 .help = "The names of the grammars loaded.",
                 .on_inq = grammars.names});
}

}  // namespace ear
