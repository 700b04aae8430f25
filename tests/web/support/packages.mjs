import { createRequire } from 'node:module';

/** Gives the packages of the page, which are installed beside it. */
export const require_package = createRequire(new URL('../../../web/package.json', import.meta.url));
