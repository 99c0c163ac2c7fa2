#pragma once

// SpiderMonkey as this program uses it; only for the sources of this folder.

#include <js/Initialization.h>
#include <jsapi.h>

#include <memory>
#include <span>
#include <string_view>

#include "task_manager/script/jobs.h"
#include "task_manager/script/watch.h"

namespace vxml::script {

/// The JSContext of a thread, which the engines of that thread share; each has a realm of its own.
/// Compiling to machine code is off: scripts are short, and no page of the process is writable and
/// executable.
class Context {
 public:
  /// Made at the first call of a thread, kept until the thread ends and the last holder lets go.
  /// `self_hosted_code` is what write_self_hosted_code wrote; it lives as long as the process.
  static std::shared_ptr<Context> OfThread(std::string_view self_hosted_code);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  JSContext* js() const { return js_; }
  Watch& watch() { return watch_; }
  Jobs& jobs() { return jobs_; }
  void set_most_heap_bytes(std::size_t bytes);

 private:
  explicit Context(std::string_view self_hosted_code);

  struct Destroy {
    void operator()(JSContext* js) const { JS_DestroyContext(js); }
  };
  std::unique_ptr<JSContext, Destroy> owned_;
  JSContext* js_ = owned_.get();
  Jobs jobs_;
  Watch watch_;
};

/// What SpiderMonkey's own library of functions compiles to; reading that is much quicker than
/// compiling it. Calls `write` with it. REQUIRES: no context has been made in this process.
bool WriteSelfHostedCode(JS::SelfHostedWriter write);

/// The build ID of the SpiderMonkey that is loaded (an ELF note, bytes), empty if it has none.
std::span<const char> LibraryBuildId();

}  // namespace vxml::script
