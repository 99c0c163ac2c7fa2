// The speech recognition module's twin: typed and scripted text for speech.

#include <CLI/CLI.hpp>
#include <boost/asio/io_context.hpp>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>

#include "srm_stub/recognizer_module.h"
#include "vm_protocol/runtime/module_main.h"

namespace {

constexpr std::size_t kMaxFileBytes = 1u << 20;

vm::Result<std::string> ReadTextFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text(kMaxFileBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!file.eof() && file.fail()) {
    return vm::Fail(vm::Errc::kUnavailable, "cannot read '" + path + "': " + std::strerror(errno));
  }
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > kMaxFileBytes) {
    return vm::Fail(vm::Errc::kTooLong,
                    "'" + path + "' is over " + std::to_string(kMaxFileBytes) + " bytes");
  }
  return text;
}

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
             scheduler,
             srm_stub::RecognizerModule::Options{
                 .module_version = "Galatea SRM stub " GALATEA_VERSION, .read_file = ReadTextFile});
       }});
}
