# cmake -DSOURCE=.. -DFILE=.. -P WriteCommit.cmake: a header with the commit of the tree, written only when it changes: that of
# $DMISE_COMMIT, else of git, else "unknown".
set(COMMIT "$ENV{DMISE_COMMIT}")
if(NOT COMMIT)
  execute_process(COMMAND git -c safe.directory=* -C ${SOURCE} describe --always --dirty --abbrev=12 --match=none
                  OUTPUT_VARIABLE COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(NOT COMMIT)
  set(COMMIT unknown)
endif()
set(text "#define DMISE_COMMIT \"${COMMIT}\"\n")
if(EXISTS ${FILE})
  file(READ ${FILE} before)
endif()
if(NOT "${before}" STREQUAL "${text}")
  file(WRITE ${FILE} "${text}")
endif()
