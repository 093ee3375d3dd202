# SPDX-License-Identifier: BSD-3-Clause
# Sourced: options of programs that were built with a sanitizer. What is suppressed, and why, stands in *.supp beside this file.
SANITIZERS="$REPOSITORY/test/sanitizers"

# use_sanitizer_options [FOLDER]: with a folder every process leaves what it finds there: nobody reads what a node prints, and
# what ends a node with respawn may not fail a test.
use_sanitizer_options() {
  local log=""
  if [ $# -gt 0 ]; then
    rm -rf "$1"
    mkdir -p "$1"
    log=":log_path=$1/report:log_exe_name=1"
  fi
  # gcc's UndefinedBehaviorSanitizer ignores log_path beside AddressSanitizer: it aborts, which AddressSanitizer then reports.
  export ASAN_OPTIONS="detect_stack_use_after_return=1:strict_string_checks=1:handle_abort=1$log"
  export LSAN_OPTIONS="suppressions=$SANITIZERS/lsan.supp:print_suppressions=0"  # what was suppressed is no finding
  export UBSAN_OPTIONS="print_stacktrace=1:abort_on_error=1$log"
  export TSAN_OPTIONS="suppressions=$SANITIZERS/tsan.supp:second_deadlock_stack=1:ignore_noninstrumented_modules=1$log"
}

# show_sanitizer_reports FOLDER: prints them; fails when there is one.
show_sanitizer_reports() {
  local reports
  mapfile -t reports < <(find "$1" -type f -size +0 | sort)
  [ "${#reports[@]}" -eq 0 ] || head -n 60 "${reports[@]}"
  echo "${#reports[@]} processes with findings"
  [ "${#reports[@]}" -eq 0 ]
}
