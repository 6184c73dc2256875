# Installs the charting library of the report's page from npm into FOLDER, as PAGE/package-lock.json pins it, and
# writes FOLDER/charts.js. Nothing is done while that lock file is the one installed. A failure (no network) is no
# failure of the build: charts.js is then empty, and the next build tries again.
#   cmake -DNPM=... -DPAGE=... -DFOLDER=... -P fetch_charts.cmake
file(MAKE_DIRECTORY ${FOLDER})
set(lock ${PAGE}/package-lock.json)
set(stamp ${FOLDER}/installed-package-lock.json)
set(library ${FOLDER}/node_modules/echarts/dist/echarts.min.js)
file(SHA256 ${lock} wanted)
if(EXISTS ${stamp} AND EXISTS ${library} AND EXISTS ${FOLDER}/charts.js)
  file(SHA256 ${stamp} installed)
  if(installed STREQUAL wanted)
    file(TOUCH ${stamp})
    return()
  endif()
endif()
file(REMOVE ${stamp})
file(COPY ${PAGE}/package.json ${lock} DESTINATION ${FOLDER})
execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --fetch-retries=1
                WORKING_DIRECTORY ${FOLDER} RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE messages)
if(result EQUAL 0 AND EXISTS ${library})
  file(COPY_FILE ${library} ${FOLDER}/charts.js ONLY_IF_DIFFERENT)
  file(COPY_FILE ${lock} ${stamp})
  file(TOUCH ${stamp})
else()
  message("report: npm cannot fetch the charting library; without it there is no `ltcfit report`\n${messages}")
  file(WRITE ${FOLDER}/charts.js "")
endif()
