#include "apps/failure.h"

#include <fmt/format.h>

#include <new>
#include <system_error>

#include "apps/exit_status.h"
#include "base/output_lost.h"
#include "base/progress.h"
#include "base/require.h"
#include "base/shortened.h"
#include "version.h"

namespace softland::apps {
namespace {

Failure internal_error(std::string_view what) {
  return {
      exit_internal_error,
      fmt::format("internal error: {}. This is a fault of softland {}, not of your input: please report it with this message, "
                  "the command and the scene file",
                  what, version)};
}

}  // namespace

Failure failure_of(const std::exception_ptr& exception) {
  try {
    std::rethrow_exception(exception);
  } catch (const InvalidRequest& error) {
    return {exit_bad_input, with_words_shortened(error.with_fields("--"))};
  } catch (const InvalidInput& error) {
    return {exit_bad_input, with_words_shortened(error.what())};
  } catch (const Interrupted& error) {
    return {exit_interrupted, error.what()};
  } catch (const OutputLost& error) {
    return {exit_output_lost, error.what()};
  } catch (const std::bad_alloc&) {
    return {exit_system_error, "not enough memory; use fewer --jobs or a smaller study"};
  } catch (const std::system_error& error) {
    return {exit_system_error, fmt::format("the operating system refused a request: {}", error.what())};
  } catch (const std::exception& error) {
    return internal_error(error.what());
  } catch (...) {
    return internal_error("an exception of unknown type");
  }
}

}  // namespace softland::apps
