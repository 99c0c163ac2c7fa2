#include "task_manager/script/context.h"

#include <js/BuildId.h>
#include <js/ContextOptions.h>
#include <js/GCAPI.h>
#include <js/Initialization.h>
#include <js/Principals.h>
#include <jsfriendapi.h>
#include <link.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace vxml::script {
namespace {

constexpr std::size_t kStackBytes = std::size_t{512} << 10;
constexpr std::string_view kGnu("GNU\0", 4);
constexpr std::size_t kMostEvalCharacters = std::size_t{1} << 20;

/// The library, ready from the first use in the process until its end.
struct Library {
  Library() {
    JS::SetProcessBuildIdOp([](JS::BuildIdCharVector* out) {
      const auto id = LibraryBuildId();
      return out->append(id.data(), id.size());
    });
    JS::DisableJitBackend();
    JS_Init();
  }
  ~Library() { JS_ShutDown(); }
};

JSContext* NewContext() {
  static const Library library;
  JSContext* context = JS_NewContext(JS::DefaultHeapMaxBytes);
  if (!context) {
    std::fputs("SpiderMonkey cannot start: no memory\n", stderr);
    std::abort();
  }
  return context;
}

/// The GNU build ID among the notes that begin at `at`, empty if there is none.
std::span<const char> BuildIdAmong(const char* at, const char* end) {
  while (end - at > static_cast<std::ptrdiff_t>(sizeof(ElfW(Nhdr)))) {
    ElfW(Nhdr) note;
    std::memcpy(&note, at, sizeof note);
    const char* name = at + sizeof note;
    const char* value = name + ((note.n_namesz + 3) & ~3U);
    if (note.n_type == NT_GNU_BUILD_ID && std::string_view(name, note.n_namesz) == kGnu) {
      return {value, note.n_descsz};
    }
    at = value + ((note.n_descsz + 3) & ~3U);
  }
  return {};
}

struct LoadedFile {
  ElfW(Addr) wanted;  ///< some address within
  std::span<const char> build_id;
};

/// Whether `object` is the wanted file, as dl_iterate_phdr asks.
int Visit(dl_phdr_info* object, std::size_t, void* data) {
  auto& file = *static_cast<LoadedFile*>(data);
  const std::span parts(object->dlpi_phdr, object->dlpi_phnum);
  const bool wanted = std::ranges::any_of(parts, [&](const auto& part) {
    const ElfW(Addr) begin = object->dlpi_addr + part.p_vaddr;
    return part.p_type == PT_LOAD && file.wanted >= begin && file.wanted - begin < part.p_memsz;
  });
  if (!wanted) return 0;
  for (const auto& part : parts) {
    if (part.p_type != PT_NOTE || !file.build_id.empty()) continue;
    const auto* begin = reinterpret_cast<const char*>(object->dlpi_addr + part.p_vaddr);
    file.build_id = BuildIdAmong(begin, begin + part.p_memsz);
  }
  return 1;
}

/// The code behind the build ID, if that is the ID of the library that is loaded.
JS::SelfHostedCache UsableCode(std::string_view all) {
  const auto id = LibraryBuildId();
  if (id.empty() || !all.starts_with(std::string_view(id.data(), id.size()))) return nullptr;
  return {reinterpret_cast<const std::uint8_t*>(all.data()) + id.size(), all.size() - id.size()};
}

/// Text that scripts make into code is no longer than that of a document.
bool AllowsCode(JSContext*, JS::RuntimeCode, JS::HandleString code) {
  return code && JS_GetStringLength(code) <= kMostEvalCharacters;
}

}  // namespace

std::span<const char> LibraryBuildId() {
  static const std::span<const char> id = [] {
    LoadedFile file{reinterpret_cast<ElfW(Addr)>(&JS_NewContext), {}};
    dl_iterate_phdr(&Visit, &file);
    return file.build_id;
  }();
  return id;
}

bool WriteSelfHostedCode(JS::SelfHostedWriter write) {
  JSContext* js = NewContext();
  const bool done = JS::InitSelfHostedCode(js, nullptr, write);
  JS_DestroyContext(js);
  return done;
}

std::shared_ptr<Context> Context::OfThread(std::string_view self_hosted_code) {
  thread_local const std::shared_ptr<Context> context(new Context(self_hosted_code));
  return context;
}

Context::Context(std::string_view self_hosted_code)
    : owned_(NewContext()), jobs_(js_), watch_([js = js_] { JS_RequestInterruptCallback(js); }) {
  JS_SetNativeStackQuota(js_, kStackBytes);
  JS::ContextOptionsRef(js_).setAsmJS(false).setWasm(false);
  static const JSSecurityCallbacks security{&AllowsCode, nullptr};
  JS_SetSecurityCallbacks(js_, &security);
  JS_SetContextPrivate(js_, this);
  JS::SetJobQueue(js_, &jobs_);
  JS_AddInterruptCallback(js_, [](JSContext* js) {
    auto& self = *static_cast<Context*>(JS_GetContextPrivate(js));
    return self.watch_.verdict() == Watch::Verdict::kWell;
  });
  if (!JS::InitSelfHostedCode(js_, UsableCode(self_hosted_code))) {
    std::fputs("SpiderMonkey cannot start: no memory\n", stderr);
    std::abort();
  }
}

Context::~Context() { JS::SetJobQueue(js_, nullptr); }

void Context::set_most_heap_bytes(std::size_t bytes) {
  JS_SetGCParameter(js_, JSGC_MAX_BYTES,
                    static_cast<std::uint32_t>(std::min<std::size_t>(bytes, UINT32_MAX)));
}

}  // namespace vxml::script
