// The reader's token: taken from the address, where it is not sent anywhere, or from before.

const KEY = "seacage-token";

/** The token in use, or null. */
export function token() {
  const given = new URLSearchParams(location.hash.slice(1)).get("token");
  if (given) {
    keepToken(given);
    history.replaceState(null, "", location.pathname + location.search);
  }
  return sessionStorage.getItem(KEY);
}

export const keepToken = (given) => sessionStorage.setItem(KEY, given);
export const dropToken = () => sessionStorage.removeItem(KEY);
