#include "app/failure.h"

#include <new>
#include <stdexcept>

#include "app/exit_codes.h"
#include "base/refusal.h"
#include "export/atomic_file.h"

namespace ltcfit::app {

Failure failureOf(const std::exception_ptr& exception) {
  try {
    std::rethrow_exception(exception);
  } catch (const InputError& error) {
    return {error.what(), kExitBadInput};
  } catch (const Refusal& error) {
    return {error.what(), kExitBadInput};
  } catch (const std::bad_alloc&) {
    return {"out of memory", kExitFailure};
  } catch (const std::logic_error& error) {
    return {std::string("internal error: ") + error.what(), kExitFailure};
  } catch (const std::exception& error) {
    return {error.what(), kExitFailure};
  } catch (...) {
    return {"internal error of an unknown kind", kExitFailure};
  }
}

}  // namespace ltcfit::app
