import { Page } from './page.js';
import { expose_probe } from './probe.js';

expose_probe(new Page());
