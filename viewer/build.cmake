# Builds the page in BUILD/work, so that the source tree stays as it is: SOURCE's files are copied there, packages fetched (npm ci), types
# checked, the page made and left as BUILD/report.html. Where packages cannot be fetched there is none, and a warning; what is wrong with our own
# source is an error.
file(MAKE_DIRECTORY "${BUILD}/work")
file(REMOVE "${BUILD}/report.html")
file(REMOVE_RECURSE "${BUILD}/work/src" "${BUILD}/work/dist")
file(COPY "${SOURCE}/src" "${SOURCE}/index.html" "${SOURCE}/package.json" "${SOURCE}/package-lock.json" "${SOURCE}/.npmrc"
          "${SOURCE}/tsconfig.json" "${SOURCE}/vite.config.ts" DESTINATION "${BUILD}/work")

# The packages are fetched again when their list is another.
file(SHA256 "${SOURCE}/package-lock.json" lock)
set(fetched "")
if(EXISTS "${BUILD}/work/fetched.txt")
  file(READ "${BUILD}/work/fetched.txt" fetched)
endif()
if(NOT fetched STREQUAL lock)
  execute_process(COMMAND "${NPM}" ci --no-audit --no-fund --fetch-retries=1 --fetch-retry-maxtimeout=5000 WORKING_DIRECTORY "${BUILD}/work" RESULT_VARIABLE failed
                  OUTPUT_FILE "${BUILD}/npm.log" ERROR_FILE "${BUILD}/npm.log")
  if(failed)
    message(WARNING "The viewer's packages could not be fetched (${BUILD}/npm.log): reports are plain pages. Remove ${BUILD}/built.stamp to try again.")
    file(WRITE "${BUILD}/built.stamp" "")
    return()
  endif()
  file(WRITE "${BUILD}/work/fetched.txt" "${lock}")
endif()

foreach(step "node_modules/typescript/bin/tsc;--noEmit" "node_modules/vite/bin/vite.js;build;--logLevel;warn")
  execute_process(COMMAND "${NODE}" ${step} WORKING_DIRECTORY "${BUILD}/work" RESULT_VARIABLE failed OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(failed)
    message(FATAL_ERROR "The viewer does not build:\n${text}")
  endif()
endforeach()
configure_file("${BUILD}/work/dist/index.html" "${BUILD}/report.html" COPYONLY)
file(WRITE "${BUILD}/built.stamp" "")
