# Writes ${out} with the commit of ${source_dir}, "+" where files changed since; only when that changed, so
# that nothing else is built again.
set(commit "unknown")
execute_process(COMMAND git -C ${source_dir} describe --always --abbrev=8 --dirty=+
  OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(NOT failed)
  set(commit "${described}")
endif()
set(text "#pragma once\n\nnamespace sunfleck {\ninline constexpr char kCommit[] = \"${commit}\";\n}  // namespace sunfleck\n")
if(EXISTS ${out})
  file(READ ${out} before)
endif()
if(NOT "${text}" STREQUAL "${before}")
  file(WRITE ${out} "${text}")
endif()
