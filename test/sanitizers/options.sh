# SPDX-License-Identifier: BSD-3-Clause
# Sourced: options of programs that were built with a sanitizer. What is suppressed, and why, stands in the files beside.
SANITIZERS="$REPOSITORY/test/sanitizers"
export ASAN_OPTIONS="detect_stack_use_after_return=1:strict_string_checks=1"
export LSAN_OPTIONS="suppressions=$SANITIZERS/lsan.supp:print_suppressions=0"
export UBSAN_OPTIONS="suppressions=$SANITIZERS/ubsan.supp:print_stacktrace=1"
export TSAN_OPTIONS="suppressions=$SANITIZERS/tsan.supp:ignore_noninstrumented_modules=1:second_deadlock_stack=1"
