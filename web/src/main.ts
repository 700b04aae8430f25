import { Page } from './page.js';
import { element } from './panel/element.js';
import { keep_focus } from './panel/focus_keeper.js';
import { expose_probe } from './probe.js';

try {
  keep_focus(element('view'));
  expose_probe(new Page());
} catch (error) {
  element('connection').dataset.phase = 'closed';
  element('connection-text').textContent = 'This page needs WebGL 2';
  throw error;
}
