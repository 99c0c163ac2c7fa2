#include "fsm/base/large_pages.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace fsm {

#ifdef __GLIBC__
void UseLargePages() {
  constexpr int kHeapGrowsBy = 64 << 20;
  mallopt(M_ARENA_MAX, 1);
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the largest value that glibc accepts
  mallopt(M_TOP_PAD, kHeapGrowsBy);
  auto* const begin = static_cast<std::byte*>(sbrk(0));
  void* volatile grown = std::malloc(1 << 20);
  const auto size = static_cast<std::byte*>(sbrk(0)) - begin;
  std::free(grown);
  if (size > 0) madvise(begin, static_cast<std::size_t>(size), MADV_HUGEPAGE);
}
#else
void UseLargePages() {}
#endif

}  // namespace fsm
