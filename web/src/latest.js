// Latest only: while an answer is awaited, of all newer questions just the last is kept.

/**
 * Make a function that asks in turn and never queues.
 *
 * @param {(question: any) => Promise<any>} ask
 * @returns {(question: any) => Promise<any>} resolves to undefined where a newer question came
 */
export function latestOnly(ask) {
  let busy = false;
  let waiting = null;

  async function next(question, settle) {
    busy = true;
    try {
      const answer = await ask(question);
      // Overtaken: the reader waits for the answer to the later question.
      settle.resolve(waiting ? undefined : answer);
    } catch (error) {
      if (waiting) settle.resolve(undefined);
      else settle.reject(error);
    } finally {
      busy = false;
      const [newer, itsSettle] = waiting ?? [];
      waiting = null;
      if (itsSettle) next(newer, itsSettle);
    }
  }

  return (question) => new Promise((resolve, reject) => {
    const settle = { resolve, reject };
    if (!busy) next(question, settle);
    else {
      waiting?.[1].resolve(undefined);
      waiting = [question, settle];
    }
  });
}
