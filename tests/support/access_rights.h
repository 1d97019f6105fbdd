// Runs tests of access rights as root, too.
//
// Root may read and write everything. Such a test therefore runs in a child process that has given up the two capabilities that
// override access rights (capabilities(7)). The programs that it starts cannot get them back. The user stays the same, because
// another one could not read a program that was built under /root.
#pragma once

#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <functional>

namespace softland::test {

/// Makes the calling thread, and every program that it starts, obey access rights from now on. Returns false if that fails.
inline bool give_up_ignoring_access_rights() {
  __user_cap_header_struct header{.version = _LINUX_CAPABILITY_VERSION_3, .pid = 0};
  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> sets{};
  if (::syscall(SYS_capget, &header, sets.data()) != 0) return false;
  for (const int capability : {CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH}) {
    // A program that root starts would get the capabilities of the bounding set.
    if (::prctl(PR_CAPBSET_READ, capability) == 1 && ::prctl(PR_CAPBSET_DROP, capability) != 0) return false;
    auto& set = sets.at(static_cast<std::size_t>(CAP_TO_INDEX(capability)));
    const auto others = ~static_cast<unsigned>(CAP_TO_MASK(capability));
    set.effective &= others;
    set.permitted &= others;
    set.inheritable &= others;
  }
  return ::syscall(SYS_capset, &header, sets.data()) == 0;
}

/// Runs `body` under access rights, and reports its failures. It runs in a process of its own, so that it cannot end the test,
/// and its changes of memory are lost.
inline void expect_where_access_rights_bind(const std::function<void()>& body) {
  if (::geteuid() != 0) {
    body();
    return;
  }
  std::fflush(nullptr);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    // noexcept: an exception must not continue this process with the following tests.
    [&]() noexcept {
      EXPECT_TRUE(give_up_ignoring_access_rights()) << "root cannot give up its capabilities here";
      body();
    }();
    std::fflush(nullptr);
    ::_exit(::testing::Test::HasFailure() ? 1 : 0);
  }
  int status = -1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "see the failures above; wait status " << status;
}

}  // namespace softland::test
