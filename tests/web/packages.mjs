// Modules from the folder where install.sh has put the packages, which is outside the source tree.
import { createRequire } from 'node:module';
import { resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

export function load(buildWeb, name) {
  return import(pathToFileURL(createRequire(resolve(buildWeb, 'package.json')).resolve(name)));
}
