// The speech synthesis module's twin: the same slots and reports over tables, without sound.

#include <CLI/CLI.hpp>
#include <boost/asio/io_context.hpp>
#include <iostream>
#include <string>

#include "ssm/voice/voice_module.h"
#include "ssm_stub/rule_engine.h"
#include "vm_protocol/runtime/module_main.h"

namespace {

constexpr const char* kModuleVersion = "Galatea SSM stub " GALATEA_VERSION;

}  // namespace

int main(int argc, char** argv) {
  bool print_version = false;
  // Taken and not used, so that a command line for ssm or for the original works here too.
  std::string ignored;
  return vm::RunModule(
      argc, argv,
      {.name = "ssm_stub",
       .description = "Stand-in for the speech synthesis module: phonemes by rule, exact, silent",
       .module_name = "SSM",
       .original_port = 10600,
       .virtual_by_default = true,
       .add_options =
           [&](CLI::App& app) {
             app.add_flag("-v", print_version, "Print the versions and end");
             app.add_option("-C", ignored, "Accepted for ssm's sake; not read");
             app.add_option("--sink", ignored, "Accepted for ssm's sake; there is no sound");
           },
       .before_start =
           [&] {
             if (!print_version) return -1;
             std::cout << kModuleVersion << "\nProtocol Ver. 1.0" << std::endl;
             return 0;
           },
       .make =
           [](vm::Scheduler& scheduler, boost::asio::io_context&) {
             return std::make_unique<ssm::VoiceModule>(
                 scheduler,
                 ssm::VoiceModule::Parts{ssm_stub::MakeRuleEngine(),
                                         std::make_unique<ssm::ClockSink>(scheduler),
                                         std::make_unique<ssm::InlineWorker>()},
                 ssm::VoiceModule::Options{.module_version = kModuleVersion});
           }});
}
