#pragma once

namespace fsm {

/// Has the memory of this process come in pages of 2 MB as far as the kernel has them, from one
/// heap that keeps what was freed. The first picture touches 60 MB, and each of 15 000 small pages
/// is a trap when it is touched first, which costs most in a virtual machine. Only advice: without
/// glibc, or where the kernel gives no such pages, nothing changes. To be called once, before the
/// first thread is made.
void UseLargePages();

}  // namespace fsm
