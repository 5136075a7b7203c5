// Preferences stored in this browser. Without storage they last until the page closes.

const prefix = "heliograph.";

function read(key: string): string | null {
  try {
    return localStorage.getItem(prefix + key);
  } catch {
    return null;
  }
}

function write(key: string, value: string): void {
  try {
    localStorage.setItem(prefix + key, value);
  } catch {
    // Storage is disabled or full.
  }
}

export const preferences = {
  flag: (key: string, defaultValue: boolean): boolean => {
    const stored = read(key);
    return stored === null ? defaultValue : stored === "1";
  },
  setFlag: (key: string, value: boolean): void => write(key, value ? "1" : "0"),
  text: (key: string, defaultValue: string): string => read(key) ?? defaultValue,
  setText: (key: string, value: string): void => write(key, value),
  remove: (key: string): void => {
    try {
      localStorage.removeItem(prefix + key);
    } catch {
      // Storage is disabled.
    }
  },
};

const nameKey = "name";

/** The name that this browser's user has given; undefined while there is none. */
export function participantName(): string | undefined {
  return preferences.text(nameKey, "") || undefined;
}

export function setParticipantName(name: string): void {
  preferences.setText(nameKey, name.trim());
}
