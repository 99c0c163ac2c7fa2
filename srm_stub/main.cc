// The speech recognition module's twin: typed and scripted text for speech.

#include <CLI/CLI.hpp>
#include <boost/asio/io_context.hpp>
#include <string>

#include "srm_stub/recognizer_module.h"
#include "vm_protocol/core/text_file.h"
#include "vm_protocol/runtime/module_main.h"

namespace {

constexpr std::size_t kMaxFileBytes = 1u << 20;

}  // namespace

int main(int argc, char** argv) {
  return vm::RunModule(
      argc, argv,
      {.name = "srm_stub",
       .description = "Stand-in for the speech recognition module: what is typed counts as said",
       .module_name = "SRM",
       .virtual_by_default = true,
       .make = [](vm::Scheduler& scheduler, boost::asio::io_context&) {
         return std::make_unique<srm_stub::RecognizerModule>(
             scheduler, srm_stub::RecognizerModule::Options{
                            .module_version = "Galatea SRM stub " GALATEA_VERSION,
                            .read_file = [](const std::string& path) {
                              return vm::ReadTextFile(path, kMaxFileBytes);
                            }});
       }});
}
