# Writes the version header; leaves it untouched if nothing has changed, so that nothing is rebuilt.
execute_process(COMMAND git rev-parse --short=7 HEAD WORKING_DIRECTORY ${SOURCE_DIR}
                OUTPUT_VARIABLE WEFT_COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT WEFT_COMMIT)
  set(WEFT_COMMIT unknown)
endif()
configure_file(${SOURCE_DIR}/server/version.h.in ${OUTPUT} @ONLY)
