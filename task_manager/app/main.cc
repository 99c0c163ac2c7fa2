#include <CLI/CLI.hpp>
#include <iostream>

#include "task_manager/app/options.h"
#include "task_manager/app/session_processes.h"
#include "task_manager/fetch/uri.h"

namespace vxml {

SessionOptions MakeSessionOptions(const Options& options) {
  SessionOptions session;
  session.uri = fetch::FromPath(options.document);
  for (const std::string& root : options.allow) {
    session.fetch.allowed_roots.push_back(fetch::FromPath(root));
  }
  session.properties["fetchtimeout"] = std::to_string(options.fetch_timeout_ms) + "ms";
  session.fetch.default_timeout = Millis(options.fetch_timeout_ms);  // of --check
  session.strict_markup = options.strict;
  session.languages = options.languages;
  const auto put = [](const std::vector<std::string>& pairs, auto& into) {
    for (const std::string& pair : pairs) {
      const std::size_t equals = pair.find('=');
      if (equals == std::string::npos) {
        throw std::runtime_error("'" + pair + "': expected NAME=VALUE");
      }
      into[pair.substr(0, equals)] = pair.substr(equals + 1);
    }
  };
  put(options.properties, session.properties);
  put(options.variables, session.session_variables);
  session.script.on_stuck = SessionProcesses::EndStuck;
  return session;
}

int CodeOf(const SessionResult& result, bool started, bool ran_out) {
  if (result.failed) return started ? kFailed : kNotStarted;
  return ran_out ? kRanOut : kEnded;
}

}  // namespace vxml

int main(int argc, char** argv) {
  vxml::Options options;
  CLI::App app{"task_manager: runs dialogues written in VoiceXML 2.0 and 2.1."};
  app.set_version_flag("--version", "task_manager (Galatea) " GALATEA_VERSION);
  app.add_option("document", options.document, "file or URI of the first document")->required();
  app.add_option("--platform", options.platform,
                 "text (prompts and input in text) or agent (a hub)")
      ->check(CLI::IsMember({"text", "agent"}));
  app.add_option("--script", options.scripts,
                 "input script of the text platform; - = standard input");
  app.add_option("--transcript", options.transcript,
                 "json, text or none; auto: json with a script, else text")
      ->check(CLI::IsMember({"auto", "json", "text", "none"}));
  app.add_option("--transcript-file", options.transcript_file, "write the transcript there");
  app.add_option("--trace", options.trace,
                 "what was selected, matched, handled and fetched, in JSON lines; - = stderr")
      ->expected(0, 1)
      ->default_str("-");
  app.add_option("--connect", options.connect,
                 "the hub: unix:PATH, tcp:HOST:PORT or tls:HOST:PORT");
  app.add_option("--token-file", options.credentials.token_file, "the secret the hub asks for");
  app.add_option("--certificate", options.credentials.certificate, "tls: what we show (PEM)");
  app.add_option("--key", options.credentials.key, "tls: its key (PEM)");
  app.add_option("--authority", options.credentials.authority,
                 "tls: who signs for the others (PEM)");
  app.add_option("--name", options.name, "this module's name at the hub");
  app.add_option("--out", options.out, "with a hub: a film of the whole dialogue, FILE.mp4");
  app.add_option("--sessions", options.sessions, "independent sessions of the same document")
      ->check(CLI::Range(1, 1000));
  app.add_option("--allow", options.allow,
                 "only fetch from these files, folders or URIs and what lies below");
  app.add_option("--property", options.properties, "platform property, NAME=VALUE");
  app.add_option("--session-variable", options.variables, "e.g. connection.remote.uri=tel:123");
  app.add_option("--languages", options.languages,
                 "what can be spoken and heard, as en,ja (default: everything); others are "
                 "error.unsupported.language")
      ->delimiter(',');
  app.add_option("--fetch-timeout", options.fetch_timeout_ms, "ms, where no fetchtimeout says")
      ->check(CLI::Range(1, 600'000));
  app.add_flag("--strict", options.strict, "unknown emotions are error.unsupported.emotion");
  app.add_flag("--check", options.check, "only check the document and what it refers to");
  app.add_flag("--graph", options.graph, "write the dialogue's flow as DOT");
  app.footer(
      "Exit status: 0 ended, 1 ended by an error event, 2 not started or not correct, "
      "3 bad usage, 4 the script ended before the dialogue. See docs/dialogs.md.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? vxml::kEnded : vxml::kUsage;
  }
  try {
    if (app.count("--trace") > 0 && options.trace.empty()) options.trace = "-";
    if (options.check) return vxml::RunCheck(options);
    if (options.graph) return vxml::RunGraph(options);
    return vxml::RunSessions(options);
  } catch (const std::exception& error) {
    std::cerr << "task_manager: " << error.what() << "\n";
    return vxml::kUsage;
  }
}
