/** The server refused a command; the fields are those of its `error` message. */
export class CommandError extends Error {
  /** @param {import('./messages.js').ErrorMessage} message */
  constructor(message) {
    super(message.message);
    this.name = 'CommandError';
    this.code = message.code;
    this.command = message.command;
    this.field = message.field;
    this.value = message.value;
    this.limit = message.limit;
    this.hint = message.hint;
  }
}

/** The connection ended before the answer arrived, or there is none. */
export class ConnectionLost extends Error {
  /** @param {string} reason */
  constructor(reason) {
    super(reason);
    this.name = 'ConnectionLost';
  }
}

/** An answer did not arrive in time. The command may have been executed, or may still be. */
export class CallTimeout extends Error {
  /**
   * @param {string} command
   * @param {number} milliseconds
   */
  constructor(command, milliseconds) {
    super(`${command}: no answer within ${milliseconds} ms`);
    this.name = 'CallTimeout';
    this.command = command;
    this.milliseconds = milliseconds;
  }
}
