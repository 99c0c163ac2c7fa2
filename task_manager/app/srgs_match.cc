// srgs_match GRAMMAR --input "tokens": does the grammar accept the words, and how does it parse
// them? The output is described in docs/dialogs.md.
#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>
#include <iterator>

#include "task_manager/fetch/fetcher.h"
#include "task_manager/fetch/uri.h"
#include "task_manager/grammar/builtin.h"
#include "task_manager/grammar/semantics.h"
#include "task_manager/grammar/store.h"

namespace {

constexpr int kAccept = 0;
constexpr int kReject = 1;
constexpr int kBadGrammar = 2;

struct Options {
  std::string grammar;
  std::vector<std::string> inputs;
  std::string rule;
  std::string language;
  bool dtmf = false;
  bool from_stdin = false;
  bool check = false;
  bool lenient = false;
};

int Judge(const vxml::srgs::Rule& rule, const std::string& input) {
  const vxml::srgs::MatchResult match = vxml::srgs::Match(rule, input);
  if (!match.parse) {
    std::cout << (match.over_limit ? "REJECT (over the matcher's limits)\n" : "REJECT\n");
    return kReject;
  }
  std::cout << "ACCEPT\n" << match.parse->Format() << "\n";
  vxml::script::Engine engine;
  auto value = vxml::srgs::Interpret(engine, *match.parse, input);
  if (value) {
    std::cout << "value " << engine.ToJson(*value) << "\n";
  } else {
    std::cout << "value error: " << value.error().text << "\n";
  }
  return kAccept;
}

int Run(const Options& options) {
  vxml::fetch::Fetcher fetcher({});
  vxml::srgs::GrammarStore store([&](const std::string& uri) -> vm::Result<std::string> {
    auto got = fetcher.Get(uri);
    if (!got) return std::unexpected(got.error());
    return std::move(got->body);
  });
  vxml::srgs::GrammarContext context;
  context.language = options.language;
  context.mode = options.dtmf ? vxml::srgs::Mode::kDtmf : vxml::srgs::Mode::kVoice;
  context.alone = !options.lenient;
  const vxml::srgs::Rule* rule = nullptr;
  vm::Result<const vxml::srgs::Grammar*> grammar = nullptr;
  if (options.grammar.starts_with("builtin:")) {
    std::string name = options.grammar.substr(8);
    if (name.starts_with("dtmf/")) context.mode = vxml::srgs::Mode::kDtmf;
    const std::size_t slash = name.find('/');
    if (slash != std::string::npos) name.erase(0, slash + 1);
    auto made =
        vxml::srgs::MakeBuiltin(vxml::srgs::ParseBuiltin(name), context.mode, options.language);
    if (made) {
      grammar = store.Add(std::move(*made));
      if (grammar) rule = (*grammar)->RootRule();
    } else {
      grammar = std::unexpected(made.error());
    }
  } else {
    std::string uri = vxml::fetch::FromPath(options.grammar);
    if (!options.rule.empty()) uri += "#" + options.rule;
    const bool needs_rule = !options.check || !options.rule.empty();
    grammar = store.Load(uri, context, needs_rule ? &rule : nullptr);
  }
  if (!grammar) {
    std::cout << "ERROR\n";
    std::cerr << "srgs_match: " << grammar.error().text << "\n";
    return kBadGrammar;
  }
  if (options.check) {
    std::cout << "OK\n";
    return kAccept;
  }
  int worst = kAccept;
  for (const std::string& input : options.inputs) worst = std::max(worst, Judge(*rule, input));
  if (options.from_stdin) {
    for (std::string line; std::getline(std::cin, line);)
      worst = std::max(worst, Judge(*rule, line));
  }
  return worst;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"Matches words against an SRGS 1.0 grammar (XML or ABNF) and prints the parse."};
  app.set_version_flag("--version", "srgs_match (Galatea) " GALATEA_VERSION);
  app.add_option("grammar", options.grammar, "file, URI, or builtin:grammar/TYPE")->required();
  app.add_option("--input", options.inputs, "the words; may be given several times");
  app.add_flag("--stdin", options.from_stdin, "one input per line from standard input");
  app.add_option("--rule", options.rule, "start at this rule instead of the root");
  app.add_option("--lang", options.language, "language of built-in types (en, ja)");
  app.add_flag("--dtmf", options.dtmf, "take the grammar's mode as dtmf where it does not say");
  app.add_flag("--lenient", options.lenient,
               "take what documents may hold: no version, namespace, language or root, and the "
               "original's shortcuts");
  app.add_flag("--check", options.check, "only compile and link the grammar");
  app.footer("Exit status: 0 all inputs accepted, 1 one rejected, 2 bad grammar, 3 bad usage.");
  try {
    app.parse(argc, argv);
    if (options.inputs.empty() && !options.from_stdin && !options.check) {
      throw CLI::RequiredError("--input, --stdin or --check");
    }
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 3;
  }
  return Run(options);
}
