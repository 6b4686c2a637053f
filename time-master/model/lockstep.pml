/* The lock-step protocol, small enough to look at every one of its states: a producer, a consumer that
 * looks one tick back, the time-master between them. Data messages get lost, either node may die
 * CRASHES times in all, at any moment, with or without its last words being heard. Says:
 *   - no deadlock: the only state without a successor is the end of the run;
 *   - no tick lost: when the master counts a tick as done by all, both have really worked on it, the
 *     consumer with the producer's message;
 *   - no tick done twice: a tick is counted once, and no process works on one that is counted;
 *   - what a node needs is still kept by the other whenever it asks (look-back, window);
 *   - the run ends, whatever dies (init {
  atomic { run monitor(PRODUCER); run monitor(CONSUMER) }
}

ltl run_ends, under weak fairness).
 *
 * model                  code
 * master                 Coordinator (time-master/coordinator.cpp): join and rejoin, done, grant
 * granted, settled       Coordinator::granted_, settled_
 * done, inc, resumes     Coordinator::Member::done, incarnation, resumes_at
 * gone                   Member::suspected or silent; monitor: PeerMonitor and Coordinator::check
 * accepted               false: the refusal of a second node of one name, which then tries again
 * publishes_from         Coordinator::publishes_from
 * lowest, highest        what Outbox keeps at least (Coordinator::keep_ticks: one more)
 * got                    Inbox of the consumer; fetch: ResendRequest (nodes/runtime/node/node_inputs.cpp)
 */
#ifndef TICKS
#define TICKS 4
#endif
#ifndef WINDOW
#define WINDOW 2
#endif
#ifndef CRASHES
#define CRASHES 2
#endif
#define LOOK_BACK 1

/* Faults to plant, so that one sees the checks find them (tests/time_master/check_model.sh). */
#ifndef FAULT
#define FAULT none
#endif
#define none 0
#define forgets_look_back 1     /* a producer keeps the window alone */
#define resumes_after_own 2     /* a process goes on after what it said done, not what all have done */
#define trusts_the_dead 3       /* a word of an earlier process of the name counts */
#define publishes_no_history 4  /* a restarted producer starts at the tick at which it resumes */
#define FAULTY(fault) (FAULT == fault)

#define KEEP (WINDOW + (FAULTY(forgets_look_back) -> 0 : LOOK_BACK))
#define HISTORY (FAULTY(publishes_no_history) -> 0 : LOOK_BACK)
#define PRODUCER 0
#define CONSUMER 1

/* Ticks count from 1, so that 0 is "none yet" in a byte. */
chan done_at_master[2] = [2 * WINDOW + 2] of { byte, byte };  /* incarnation, tick */
chan join_at_master[2] = [1] of { bit };  /* another connection: may overtake an earlier process's words */
byte granted = 0, settled = 0;
bool ended = false;
byte inc[2], done[2], resumes[2];
bool gone[2], dead[2], answered[2], accepted[2];
byte crashes = CRASHES;

byte lowest, highest;    /* ticks that the producer keeps; 0, 0: none */
bool worked[2 * (TICKS + 1)];  /* ghost: this node has worked on that tick */
#define WORKED(node, tick) worked[(node) * (TICKS + 1) + (tick)]

inline grant() {
  do
  :: settled < done[PRODUCER] && settled < done[CONSUMER] ->
     settled++;
     assert(WORKED(PRODUCER, settled) && WORKED(CONSUMER, settled))
  :: else -> break
  od;
  if
  :: settled == TICKS -> ended = true
  :: else ->
     if
     :: settled + WINDOW > granted ->
        granted = (settled + WINDOW > TICKS -> TICKS : settled + WINDOW)
     :: else
     fi
  fi
}

inline hear_join(node) {
  if
  :: inc[node] == 0 ->
     inc[node] = 1; resumes[node] = 1; accepted[node] = true
  :: inc[node] > 0 && gone[node] ->
     inc[node]++;
     resumes[node] = (FAULTY(resumes_after_own) -> done[node] : settled) + 1;
     done[node] = resumes[node] - 1;
     gone[node] = false;
     accepted[node] = true
  :: else -> accepted[node] = false
  fi;
  answered[node] = true;
  if
  :: inc[PRODUCER] > 0 && inc[CONSUMER] > 0 && !ended -> grant()
  :: else
  fi
}

inline hear_done(node) {
  if
  :: (who == inc[node] || FAULTY(trusts_the_dead)) && tick > done[node] ->
     assert(tick == done[node] + 1 && tick <= granted);
     done[node] = tick;
     grant()
  :: else /* of an earlier process of that name, or said twice */
  fi
}

active proctype master() {
  byte who, tick;
end:
  do
  :: atomic { join_at_master[PRODUCER]?_ -> hear_join(PRODUCER) }
  :: atomic { join_at_master[CONSUMER]?_ -> hear_join(CONSUMER) }
  :: atomic { done_at_master[PRODUCER]?who, tick -> hear_done(PRODUCER) }
  :: atomic { done_at_master[CONSUMER]?who, tick -> hear_done(CONSUMER) }
  od
}

/* Sees, some time later, that a process is no more. */
proctype monitor(byte node) {
end:
  do
  :: atomic { dead[node] && inc[node] > 0 && !gone[node] -> gone[node] = true; dead[node] = false }
  od
}

/* The process of this name ends; what it said last may be heard or not. */
inline die(node) {
  crashes--;
  dead[node] = true;
  if
  :: true -> skip
  :: true ->
     do
     :: done_at_master[node]?_, _
     :: empty(done_at_master[node]) -> break
     od
  fi
}

/* Joins, again and again until it is accepted. */
inline join(node) {
  do
  :: atomic { answered[node] = false; join_at_master[node]!1 };
     atomic {
       answered[node];
       if
       :: accepted[node] -> me = inc[node]; break
       :: else
       fi
     }
  od
}

active proctype producer() {
  byte me, next;
start:
  join(PRODUCER);
  next = (resumes[PRODUCER] > HISTORY -> resumes[PRODUCER] - HISTORY : 1);
  do
  :: ended -> break
  :: atomic {
       !ended && next <= TICKS && (next <= granted || next < resumes[PRODUCER]) ->
       highest = next;
       lowest = (lowest == 0 -> next : lowest);
       lowest = (highest - lowest >= KEEP -> highest - KEEP + 1 : lowest);
       if
       :: next >= resumes[PRODUCER] ->
          assert(next > settled);
          WORKED(PRODUCER, next) = true;
          done_at_master[PRODUCER]!me, next
       :: else
       fi;
       next++
     }
  :: atomic {
       !ended && crashes > 0 ->
       lowest = 0; highest = 0;
       die(PRODUCER);
       goto start
     }
  od
}

active proctype consumer() {
  byte me, next;
  bool have;  /* the message of tick `next`; earlier ones are used or part of the look-back */
start:
  join(CONSUMER);
  have = false;
  next = (resumes[CONSUMER] > LOOK_BACK -> resumes[CONSUMER] - LOOK_BACK : 1);
  do
  :: ended -> break
  :: atomic { /* published and not lost, or asked for again: either way it comes from what is kept */
       !ended && !have && next <= TICKS && highest >= next ->
       assert(lowest <= next);
       have = true
     }
  :: atomic {
       !ended && have && (next <= granted || next < resumes[CONSUMER]) ->
       if
       :: next >= resumes[CONSUMER] ->
          assert(next > settled);
          WORKED(CONSUMER, next) = true;
          done_at_master[CONSUMER]!me, next
       :: else
       fi;
       have = false;
       next++
     }
  :: atomic {
       !ended && crashes > 0 ->
       die(CONSUMER);
       goto start
     }
  od
}

init {
  atomic { run monitor(PRODUCER); run monitor(CONSUMER) }
}

ltl run_ends { <> ended }
