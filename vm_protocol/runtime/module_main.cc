#include "vm_protocol/runtime/module_main.h"

#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <boost/asio/signal_set.hpp>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <iostream>
#include <stdexcept>

#include "vm_protocol/runtime/acceptor.h"
#include "vm_protocol/runtime/module_server.h"

namespace vm {
namespace {

/// How long a batch piped in has to end its input before it is taken for a person or a program
/// that talks back and forth.
constexpr auto kBatchWait = std::chrono::milliseconds(60);

struct Options {
  std::vector<std::string> listen;
  std::string connect;
  std::string name;
  Credentials credentials;
  int original_port = 0;
  bool original_socket = false;
  std::string framing = "auto";
  std::string encoding = "utf-8";
  std::string clock = "auto";
  bool strict = false;
  bool slots_markdown = false;
};

template <typename T>
T Need(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().text);
  return std::move(*result);
}

Framing FramingOf(const std::string& word) {
  return word == "lf" ? Framing::kLf : word == "mmi" ? Framing::kMmi : Framing::kAuto;
}

/// What was read from stdin while finding out whether it is a batch.
struct Lookahead {
  std::string bytes;
  bool ended = false;
};

Lookahead ReadAhead() {
  Lookahead ahead;
  const auto deadline = std::chrono::steady_clock::now() + kBatchWait;
  while (!ahead.ended) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        deadline - std::chrono::steady_clock::now());
    pollfd waiting{STDIN_FILENO, POLLIN, 0};
    if (left.count() <= 0 || poll(&waiting, 1, static_cast<int>(left.count())) <= 0) break;
    char buffer[65536];
    const ssize_t n = read(STDIN_FILENO, buffer, sizeof(buffer));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      ahead.ended = true;
    } else {
      ahead.bytes.append(buffer, static_cast<std::size_t>(n));
    }
  }
  return ahead;
}

void AddCommonOptions(CLI::App& app, Options& options, const ProgramInfo& info) {
  app.add_option("--listen", options.listen,
                 "Wait for clients on unix:PATH, tcp:HOST:PORT or tls:HOST:PORT (may be repeated)");
  app.add_option("--connect", options.connect,
                 "Go to a hub on unix:PATH, tcp:HOST:PORT or tls:HOST:PORT");
  app.add_option("--name", options.name,
                 "The name to have at the hub (default " + info.module_name + ")");
  Credentials& shown = options.credentials;
  app.add_option("--token-file", shown.token_file, "The token both sides know (mode 600)");
  app.add_option("--certificate", shown.certificate, "tls: what we show (PEM)");
  app.add_option("--key", shown.key, "tls: its key (PEM)");
  app.add_option("--authority", shown.authority, "tls: who signs for the others (PEM)");
  if (info.original_port != 0) {
    app.add_option(
           "-p", options.original_port,
           "The original's socket mode: one client on this port, messages end in ./ (default " +
               std::to_string(info.original_port) + ")")
        ->expected(0, 1)
        ->each([&options](const std::string&) { options.original_socket = true; });
  }
  app.add_option("--framing", options.framing, "How lines end on sockets: auto, lf, mmi (./ LF)")
      ->check(CLI::IsMember({"auto", "lf", "mmi"}));
  app.add_option("--encoding", options.encoding, "utf-8, euc-jp or shift_jis");
  app.add_option(
         "--clock", options.clock,
         std::string("real, virtual, or auto") +
             (info.virtual_by_default ? ": virtual for a batch piped in, else real" : ": real"))
      ->check(CLI::IsMember({"auto", "real", "virtual"}));
  app.add_flag("--strict", options.strict, "End with exit code 1 if any error was seen");
  app.add_flag("--slots-markdown", options.slots_markdown, "Print the table of slots and end");
  app.set_version_flag("--version", info.name + " (Galatea) " GALATEA_VERSION);
}

/// Everything between the command line and the end, with its parts in order of construction.
class Program {
 public:
  Program(const Options& options, const ProgramInfo& info) : options_(options), info_(info) {}

  int Run() {
    const Framing framing = FramingOf(options_.framing);
    const Encoding encoding = Need(ParseEncoding(options_.encoding));
    const bool on_stdio =
        options_.listen.empty() && options_.connect.empty() && !options_.original_socket;
    const bool may_be_batch = options_.clock == "auto" && info_.virtual_by_default && on_stdio &&
                              isatty(STDIN_FILENO) == 0 &&
                              !(info_.needs_real_clock && info_.needs_real_clock());
    Lookahead ahead;
    if (may_be_batch) ahead = ReadAhead();

    boost::asio::io_context io;
    ClockScheduler clock(io,
                         options_.clock == "real" || (options_.clock == "auto" && !ahead.ended));
    const auto module = info_.make(clock, io);
    ModuleServer server(io, clock, *module,
                        {info_.name, options_.original_socket, options_.original_socket});
    if (options_.slots_markdown) {
      std::cout << module->slots().DocsMarkdown();
      return 0;
    }
    boost::asio::signal_set signals(io, SIGINT, SIGTERM);
    signals.async_wait([&server](const auto& error, int) {
      if (!error) server.RequestStop();
    });

    std::vector<std::unique_ptr<Acceptor>> acceptors;
    const auto listen = [&](const Endpoint& endpoint, Framing how) {
      acceptors.push_back(Acceptor::Open(
          io, endpoint, options_.credentials, how, encoding,
          [&](const Acceptor::Connection& connection) {
            if (!server.HasRoom()) return connection.stream->Close();
            server.AddPeer(connection.stream, {});
            connection.stream->ResumeReading();
          },
          [this](const std::string& text) {
            std::cerr << info_.name << ": " << text << std::endl;
          }));
      std::cerr << info_.name << ": listening on " << FormatEndpoint(acceptors.back()->endpoint())
                << std::endl;
    };
    for (const std::string& text : options_.listen) listen(Need(ParseEndpoint(text)), framing);
    if (options_.original_socket) {
      // As the original: ports up to 1024 are ignored.
      const auto port = options_.original_port > 1024 && options_.original_port < 65536
                            ? static_cast<unsigned short>(options_.original_port)
                            : info_.original_port;
      listen({Endpoint::Kind::kTcp, "127.0.0.1", port},
             options_.framing == "lf" ? Framing::kLf : Framing::kMmi);
    }
    if (!options_.connect.empty()) Connect(io, server, encoding);
    if (on_stdio) {
      ModuleServer::PeerOptions peer{.ends_module = true,
                                     .wants_errors = isatty(STDIN_FILENO) != 0,
                                     .already_read = std::move(ahead.bytes)};
      server.AddPeer(StreamPeer::Make(io, STDIN_FILENO, STDOUT_FILENO,
                                      framing == Framing::kAuto ? Framing::kLf : framing, encoding),
                     std::move(peer));
    }
    const int errors = server.Run();
    return server.failed() || (options_.strict && errors > 0) ? 1 : 0;
  }

 private:
  void Connect(boost::asio::io_context& io, ModuleServer& server, Encoding encoding) {
    const Endpoint endpoint = Need(ParseEndpoint(options_.connect));
    const std::string name = options_.name.empty() ? info_.module_name : options_.name;
    if (!IsModuleName(name)) throw std::runtime_error("'" + name + "' is not a module's name");
    // Taken apart here: g++ 12 takes a Result that is moved out of a callback for uninitialised.
    // Shared, since a signal ends our waiting before the call is over.
    struct Call {
      std::shared_ptr<StreamPeer> stream;
      std::string refusal;
    };
    const auto call = std::make_shared<Call>();
    vm::Connect(io, endpoint, options_.credentials, Framing::kLf, encoding,
                [call](const Result<std::shared_ptr<StreamPeer>>& called) {
                  if (called) {
                    call->stream = *called;
                  } else {
                    call->refusal = called.error().text;
                  }
                });
    while (call->stream == nullptr && call->refusal.empty() && !server.stopping()) io.run_one();
    if (!call->refusal.empty()) throw std::runtime_error(call->refusal);
    if (call->stream == nullptr) return;
    server.AddPeer(call->stream,
                   {.first_lines = {"to @AM set Name = " + name}, .ends_module = true});
    call->stream->ResumeReading();
  }

  const Options& options_;
  const ProgramInfo& info_;
};

}  // namespace

int RunModule(int argc, char** argv, const ProgramInfo& info) {
  Options options;
  CLI::App app(info.description, info.name);
  if (info.add_options) info.add_options(app);
  AddCommonOptions(app, options, info);
  CLI11_PARSE(app, argc, argv);
  std::signal(SIGPIPE, SIG_IGN);
  try {
    if (info.before_start) {
      if (const int code = info.before_start(); code >= 0) return code;
    }
    return Program(options, info).Run();
  } catch (const std::exception& error) {
    std::cerr << info.name << ": " << error.what() << std::endl;
    return 1;
  }
}

}  // namespace vm
