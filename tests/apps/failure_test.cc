// Every kind of exception that can end the program has its exit status, and the documentation lists every status.
#include "apps/failure.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <new>
#include <stdexcept>
#include <system_error>

#include "apps/exit_status.h"
#include "base/output_lost.h"
#include "base/progress.h"
#include "base/require.h"
#include "base/shell_word.h"
#include "program.h"
#include "version.h"

namespace softland::apps {
namespace {

using testing::HasSubstr;

template <class Exception>
Failure failure(const Exception& exception) {
  return failure_of(std::make_exception_ptr(exception));
}

TEST(Failure, OfTheUserOrTheSystemSaysWhatItIs) {
  EXPECT_EQ(failure(InvalidInput("x.toml:3: no")).status, exit_bad_input);
  EXPECT_EQ(failure(InvalidInput("x.toml:3: no")).message, "x.toml:3: no");
  EXPECT_EQ(failure(Interrupted()).status, exit_interrupted);
  EXPECT_EQ(failure(OutputLost("disk full")).status, exit_output_lost);
  EXPECT_EQ(failure(OutputLost("disk full")).message, "disk full");
  EXPECT_EQ(failure(std::bad_alloc()).status, exit_system_error);
  EXPECT_EQ(failure(std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again))).status,
            exit_system_error);
}

TEST(Failure, OfARequestNamesItsFieldsAsTheyWereTyped) {
  const InvalidRequest error(requested("waveform") + " a-b: no such, as " + requested("target") + " is 'x'");
  EXPECT_STREQ(error.what(), "waveform a-b: no such, as target is 'x'");
  EXPECT_EQ(failure(error).status, exit_bad_input);
  EXPECT_EQ(failure(error).message, "--waveform a-b: no such, as --target is 'x'");
}

TEST(Failure, OfTheProgramItselfAsksToBeReportedWithItsVersion) {
  for (const Failure& f :
       {failure(std::logic_error("odd")), failure(std::runtime_error("odd")), failure(std::out_of_range("odd"))}) {
    EXPECT_EQ(f.status, exit_internal_error);
    EXPECT_THAT(f.message, HasSubstr("internal error: odd"));
    EXPECT_THAT(f.message, HasSubstr("softland " + std::string(version)));
    EXPECT_THAT(f.message, HasSubstr("please report it"));
  }
  EXPECT_EQ(failure(3).status, exit_internal_error);
}

TEST(ExitStatus, IsListedInDocumentsAndHelp) {
  const Workplace here;
  const std::string page = read(fs::path(SOFTLAND_SOURCE_DIR) / "docs/commands.md"), help = here.run({"--help"}).out;
  for (const ExitStatus& one : exit_statuses) {
    EXPECT_THAT(page, HasSubstr(fmt::format("\n| {} | {} |\n", one.status, one.about)));
    EXPECT_THAT(help, HasSubstr(fmt::format("\n  {:<4} {}\n", one.status, one.about)));
  }
}

TEST(ShellWord, IsQuotedWhereAShellWouldNotLeaveIt) {
  EXPECT_EQ(shell_word("run-1/best.toml"), "run-1/best.toml");
  EXPECT_EQ(shell_word("my out; ls/best.toml"), "'my out; ls/best.toml'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word(""), "''");
}

}  // namespace
}  // namespace softland::apps
