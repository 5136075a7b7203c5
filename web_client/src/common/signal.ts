// A value that notifies its listeners of changes.
export class Signal<Value> {
  private current: Value;
  private readonly listeners = new Set<(value: Value) => void>();

  constructor(initial: Value) {
    this.current = initial;
  }

  get value(): Value {
    return this.current;
  }

  set(value: Value): void {
    this.current = value;
    for (const listener of this.listeners) listener(value);
  }

  /** Calls the listener now and after every change. */
  watch(listener: (value: Value) => void): void {
    this.listeners.add(listener);
    listener(this.current);
  }
}
