// The face synthesis module: lines on stdin or a socket in, a moving face out.

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "fsm/app/fsm_module.h"
#include "fsm/app/gl_face_view.h"
#include "fsm/app/one_shot.h"
#include "fsm/app/options.h"
#include "fsm/base/large_pages.h"
#include "vm_protocol/runtime/module_main.h"

int main(int argc, char** argv) {
  fsm::UseLargePages();
  fsm::Options options;
  options.module.log = fsm::StderrLog("fsm");
  bool failed = false;
  options.module.on_failure = [&failed] { failed = true; };
  // These outlive the module.
  std::optional<fsm::HeadLibrary> library;
  std::optional<fsm::GlFaceView> view;
  std::vector<char*> words = fsm::NamePositionOption(argc, argv);
  const int code = vm::RunModule(
      argc, words.data(),
      {.name = "fsm",
       .description = "Galatea's face: a talking head told what to do in lines of text",
       .module_name = "FSM",
       .original_port = 10700,
       .virtual_by_default = true,
       .add_options = [&options](CLI::App& app) { fsm::AddOptions(app, options); },
       .before_start =
           [&options] {
             fsm::ResolveOptions(options);
             return fsm::RunOnce(options) ? 0 : -1;
           },
       .needs_real_clock =
           [&options] {
             return options.view.window_mode != fsm::GlFaceView::Options::WindowMode::kHeadless;
           },
       .make = [&options, &library, &view](
                   vm::Scheduler& clock, boost::asio::io_context&) -> std::unique_ptr<vm::Module> {
         library.emplace(options.faces, options.module.tables);
         view.emplace(*library, options.view);
         return std::make_unique<fsm::FsmModule>(clock, *view, *library, fsm::MediaFiles{},
                                                 options.module);
       }});
  return code == 0 && failed ? 1 : code;
}
