// The module that talks: options, tables, the network, and the module over them.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>

#include "chat/app/settings.h"
#include "chat/core/chat_module.h"
#include "chat/tables/tables.h"
#include "vm_protocol/core/text_file.h"
#include "vm_protocol/http/curl_transport.h"
#include "vm_protocol/runtime/asio_scheduler.h"
#include "vm_protocol/runtime/credentials.h"
#include "vm_protocol/runtime/module_main.h"

namespace {

constexpr std::size_t kMaxTableBytes = 1 << 20;
constexpr std::size_t kMaxPromptBytes = 64 << 10;

template <typename T>
T OrThrow(vm::Result<T> result) {
  if (!result) throw std::runtime_error(result.error().text);
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

std::string ReadOr(const std::string& path, std::string_view carried, std::size_t most) {
  return path.empty() ? std::string(carried) : OrThrow(vm::ReadTextFile(path, most));
}

/// One of the tables: a file's, or the one the program carries under `name`.
template <typename Parse>
auto Table(const std::string& path, const char* name, std::string_view carried, Parse parse) {
  return OrThrow(parse(path.empty() ? name : path, ReadOr(path, carried, kMaxTableBytes)));
}

std::tm LocalTime() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  return local;
}

chat::Endpoint EndpointOf(const chat::Settings& settings) {
  chat::Endpoint endpoint;
  if (!settings.url.empty()) endpoint.url = OrThrow(chat::ChatUrl(settings.url));
  if (!settings.key_file.empty())
    endpoint.key = OrThrow(vm::ReadSecret(settings.key_file, "key", 1));
  endpoint.more = settings.body;
  endpoint.allow_set = settings.allow_set;
  for (const std::string& place : endpoint.allow_set) OrThrow(chat::ParseAllowed(place));
  return endpoint;
}

chat::ChatModule::Options OptionsOf(const chat::Settings& settings) {
  chat::ChatModule::Options options{
      .module_version = "Galatea chat " GALATEA_VERSION,
      .endpoint = EndpointOf(settings),
      .model = settings.model,
      .prompt = ReadOr(settings.prompt_file, chat::tables::Prompt(), kMaxPromptBytes),
      .persona = settings.persona,
      .talk = std::string(chat::tables::Talk()),
      .agent = settings.agent.empty() ? "Galatea" : settings.agent,
      .listens = settings.listen,
      .tags = Table(settings.tags_file, "tags.txt", chat::tables::Tags(), chat::TagTable::Parse),
      .abbreviations = chat::ParseAbbreviations(chat::tables::Abbreviations()),
      .apologies = Table(settings.apologies_file, "apologies.txt", chat::tables::Apologies(),
                         chat::Apologies::Parse),
      .wall_clock = LocalTime};
  for (const std::string& file : settings.rules_files)
    options.rules.push_back(Table(file, "", "", chat::Rules::Parse));
  if (options.rules.empty()) {
    options.rules.push_back(
        Table("", "rules_en.txt", chat::tables::RulesEnglish(), chat::Rules::Parse));
    options.rules.push_back(
        Table("", "rules_ja.txt", chat::tables::RulesJapanese(), chat::Rules::Parse));
  }
  return options;
}

/// The module with what it needs, in order of construction.
class Program final : public vm::Module {
 public:
  Program(vm::ClockScheduler& clock, boost::asio::io_context& io, const chat::Settings& settings)
      : transport_(
            io, clock, [&clock] { return clock.real(); }, settings.ca_file),
        module_(clock, transport_, OptionsOf(settings)) {
    for (const auto& [slot, value] : settings.limits) {
      module_.slots().Handle(vm::Set(slot, std::to_string(value)));
      if (module_.slots().Value(slot) != std::to_string(value))
        throw std::runtime_error("limits: " + slot + " cannot be " + std::to_string(value));
    }
  }
  vm::SlotMachine& slots() override { return module_.slots(); }
  bool Busy() const override { return module_.Busy(); }
  bool ExitRequested() const override { return module_.ExitRequested(); }
  void Shutdown() override { module_.Shutdown(); }

 private:
  vm::CurlTransport transport_;
  chat::ChatModule module_;
};

void AddOptions(CLI::App& app, chat::Settings& settings, std::string& config_file) {
  app.add_option("--config", config_file, "A configuration, JSON (docs/chat.md)");
  app.add_option(
      "--model-url", settings.url,
      "Where a model is asked, http://HOST:PORT or https://HOST; without it rules answer");
  app.add_option("--model", settings.model, "The model's name");
  app.add_option("--key-file", settings.key_file,
                 "A file only you can read, whose first line is the key");
  app.add_option("--ca-file", settings.ca_file,
                 "PEM: who signs the endpoint's certificate, in place of the system's");
  app.add_option("--prompt", settings.prompt_file, "The system prompt, in place of our own");
  app.add_option("--persona", settings.persona, "Who the agent is; told after the prompt");
  app.add_option("--agent", settings.agent, "The agent's name (default Galatea)");
  app.add_option("--rules", settings.rules_files, "Rules in place of our own (may be repeated)");
  app.add_option("--tags", settings.tags_file, "The table of tags, in place of our own");
  app.add_option("--apologies", settings.apologies_file, "What is said of errors");
  app.add_option("--allow-set", settings.allow_set,
                 "\"@MODULE SLOT\" that the model may set (may be repeated)");
  app.add_flag("!--no-listen", settings.listen, "Begin with Listen = OFF");
}

}  // namespace

int main(int argc, char** argv) {
  chat::Settings settings;
  std::string config_file;
  return vm::RunModule(
      argc, argv,
      {.name = "chat",
       .description = "The module that talks: a language model, or rules, with voice and face",
       .module_name = "CHAT",
       .virtual_by_default = true,
       .add_options = [&](CLI::App& app) { AddOptions(app, settings, config_file); },
       .before_start =
           [&] {
             if (config_file.empty()) return -1;
             chat::Settings configured;
             OrThrow(chat::ReadSettings(
                 config_file, OrThrow(vm::ReadTextFile(config_file, kMaxTableBytes)),
                 std::filesystem::path(config_file).parent_path().string(), configured));
             settings = chat::Over(std::move(configured), settings);
             return -1;
           },
       .needs_real_clock = [&] { return !settings.url.empty(); },
       .make =
           [&](vm::Scheduler& scheduler, boost::asio::io_context& io) {
             return std::make_unique<Program>(dynamic_cast<vm::ClockScheduler&>(scheduler), io,
                                              settings);
           }});
}
