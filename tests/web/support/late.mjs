// Tests look at pages and at scripts, and neither may count on the other's knowledge. WEFT_LATE=page:300 has
// pages hear of the server 300 ms late and draw seldom, WEFT_LATE=script:300 has scripts hear late. Then a
// test that looks at one right after it has waited for the other fails each time, not once in a hundred.

const [who, time] = (process.env.WEFT_LATE ?? ':0').split(':');
const late = (whom) => (who === whom ? Number(time) : 0); // [ms]

/** Runs in a page before its own scripts. @param delay [ms] */
function hear_late(delay) {
  const { prototype } = WebSocket;
  const own = Object.getOwnPropertyDescriptor(prototype, 'onmessage');
  const set = function (act) {
    const hear = (event) => setTimeout(() => this.readyState === WebSocket.OPEN && act(event), delay);
    own.set.call(this, act && hear);
  };
  Object.defineProperty(prototype, 'onmessage', { ...own, set });
  const draw = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (act) => setTimeout(() => draw(act), delay / 6);
}

/** Makes the pages of a browser's context late, if that is asked for. */
export async function make_pages_late(context) {
  const delay = late('page');
  if (delay > 0) await context.addInitScript(hear_late, delay);
}

/** A class of sockets for scripts that hear late, if that is asked for. */
export function late_sockets(Socket) {
  const delay = late('script');
  if (delay === 0) return Socket;
  return class extends Socket {
    set onmessage(act) {
      super.onmessage = act && ((event) => setTimeout(() => this.readyState === Socket.OPEN && act(event), delay));
    }
    get onmessage() {
      return super.onmessage;
    }
  };
}
