/* A host: two nodes behind an agent, which tells the time-master tick by tick what both have done. They
 * need what a producer publishes that the master hears itself. Either node may die, and the agent, which
 * takes both with it: CRASHES times in all, at any moment, with or without last words being heard. What
 * lockstep.pml says of nodes, this says of nodes behind an agent:
 *   - no deadlock: the only state without a successor is the end of the run;
 *   - no tick lost: when the master counts a tick as done by all, both nodes have really worked on it;
 *   - what the agent tells is in turn and was granted;
 *   - what a node needs is still kept by the producer whenever it asks (look-back, window), also after
 *     its agent has told of ticks that it now does again;
 *   - the run ends, whatever dies (ltl run_ends, under weak fairness).
 *
 * model                  code
 * master                 Coordinator (time-master/coordinator_hosts.cpp)
 * agent                  HostBarrier (time-master/host_barrier.cpp) in HostAgent (nodes/agent)
 * up                     the agent's one connection: what it says is heard in turn
 * host_done              Coordinator::Member::done of the agent
 * at, taken              HostBarrier::Node::done, HostBarrier::taken_
 * asking                 HostBarrier::asks: a Join that the master has not answered
 * mine > 0, of both      HostBarrier::expects: all who belong to the host are there
 * welcome                Welcome, and of the Topology the start that is meant for this incarnation
 * lowest, highest        what Outbox of the producer keeps
 */
#ifndef TICKS
#define TICKS 3
#endif
#ifndef WINDOW
#define WINDOW 2
#endif
#ifndef CRASHES
#define CRASHES 1
#endif
#define LOOK_BACK 1

/* Faults to plant, so that one sees the checks find them (tests/time_master/check_model.sh). */
#ifndef FAULT
#define FAULT none
#endif
#define none 0
#define host_stays_done 1    /* the master counts what the host did before one of its nodes died */
#define tells_while_asking 2 /* the agent goes on telling while it asks for a new process */
#define trusts_the_dead 3    /* the agent counts a word of an earlier process of the name */
#define counts_who_is_back 4 /* a new agent tells what the nodes that are back have done */
#define FAULTY(fault) (FAULT == fault)

#define KEEP (WINDOW + LOOK_BACK)
#define MIN(a, b) ((a) < (b) -> (a) : (b))

mtype = { JOIN, DONE, LOST };
chan up = [8] of { mtype, byte, byte, byte };       /* agent, node, tick or incarnation */
chan welcome = [2] of { byte, byte, byte, byte };   /* agent, node, incarnation, first tick */
chan producer_done = [2 * WINDOW + 2] of { byte };
chan heard[2] = [2 * WINDOW + 2] of { byte, byte }; /* incarnation, tick: done, heard by the agent */
chan asks[2] = [1] of { bit };

/* Ticks and incarnations count from 1, so that 0 is "none yet" in a byte. */
byte granted = 0, settled = 0, host_done = 0, produced = 0;
byte lowest = 0, highest = 0; /* ticks that the producer keeps */
bool ended = false;
byte agent_now = 0;           /* incarnation of the agent that the master knows */
bool agent_gone = true;
byte inc[2];                  /* of the nodes, as the master knows them */
bool lost[2], dead[2];
bool answered[2];
byte given_inc[2], given_tick[2]; /* with the answer */
byte crashes = CRASHES;
bool worked[2 * (TICKS + 1)]; /* ghost: this node has worked on that tick */
#define WORKED(node, tick) worked[(node) * (TICKS + 1) + (tick)]

inline grant() {
  do
  :: settled < produced && settled < host_done ->
     settled++;
     assert(WORKED(0, settled) && WORKED(1, settled))
  :: else -> break
  od;
  if
  :: settled == TICKS -> ended = true
  :: inc[0] > 0 && inc[1] > 0 && settled < TICKS && MIN(settled + WINDOW, TICKS) > granted ->
     granted = MIN(settled + WINDOW, TICKS)
  :: else
  fi
}

inline hear_join() {
  if
  :: inc[node] == 0 -> inc[node] = 1; welcome!who, node, 1, 1
  :: inc[node] > 0 ->
     assert(lost[node]); /* the agent has said so before it asks */
     lost[node] = false;
     inc[node]++;
     tick = settled + 1;
     if
     :: FAULTY(host_stays_done) || host_done < tick -> skip
     :: else -> host_done = tick - 1
     fi;
     welcome!who, node, inc[node], tick
  fi;
  grant()
}

active proctype master() {
  byte who, node, tick;
end:
  do
  :: atomic { producer_done?tick -> produced = tick; grant() }
  :: atomic {
       up?JOIN, who, node, _ ->
       if
       :: who == agent_now && !agent_gone -> hear_join()
       :: else
       fi
     }
  :: atomic {
       up?DONE, who, _, tick ->
       if
       :: who == agent_now && tick > host_done && !ended ->
          assert(tick == host_done + 1 && tick <= granted);
          host_done = tick;
          grant()
       :: else
       fi
     }
  :: atomic {
       up?LOST, who, node, tick ->
       if
       :: who == agent_now && tick == inc[node] -> lost[node] = true
       :: else
       fi
     }
  od
}

active proctype producer() {
  byte next = 1;
  do
  :: ended -> break
  :: atomic {
       !ended && next <= TICKS && next <= granted ->
       highest = next;
       lowest = (lowest == 0 -> next : lowest);
       lowest = (highest - lowest >= KEEP -> highest - KEEP + 1 : lowest);
       producer_done!next;
       next++
     }
  od
}

inline forget(node) {
  at[node] = 0; mine[node] = 0; asking[node] = false; told[node] = false; dead[node] = false;
  do
  :: heard[node]?_, _
  :: asks[node]?_
  :: empty(heard[node]) && empty(asks[node]) -> break
  od
}

/* What the agent hears of this node. */
inline attend(node) {
  atomic {
    (mine[node] == 0 || told[node]) && nempty(asks[node]) -> /* else a twin, refused until then */
    asks[node]?_;
    asking[node] = true;
    up!JOIN, me, node, 0
  }
}
inline hear_done(node) {
  atomic {
    heard[node]?who, tick ->
    if
    :: (who == mine[node] || FAULTY(trusts_the_dead)) && tick > at[node] ->
       assert(tick == at[node] + 1);
       at[node] = tick
    :: else /* of an earlier process */
    fi
  }
}
inline see_death(node) {
  atomic {
    dead[node] && mine[node] > 0 && !told[node] ->
    dead[node] = false;
    told[node] = true;
    up!LOST, me, node, mine[node]
  }
}

active proctype agent() {
  byte me, who, which, number, tick, taken;
  byte at[2], mine[2]; /* what each node has done, its incarnation */
  bool asking[2], told[2];
start:
  if
  :: ended -> goto over
  :: atomic { /* joins once the master has seen the last one go: its nodes are lost, they do again */
       agent_gone && !ended ->
       agent_now++; me = agent_now; agent_gone = false;
       forget(0); forget(1);
       lost[0] = inc[0] > 0; lost[1] = inc[1] > 0;
       host_done = MIN(host_done, settled);
       taken = settled
     }
  fi;
  do
  :: ended -> break
  :: attend(0)
  :: attend(1)
  :: hear_done(0)
  :: hear_done(1)
  :: see_death(0)
  :: see_death(1)
  :: atomic {
       welcome?who, which, number, tick ->
       if
       :: who == me ->
          given_inc[which] = number; given_tick[which] = tick;
          mine[which] = number; at[which] = tick - 1;
          taken = MIN(taken, at[which]);
          asking[which] = false; told[which] = false; dead[which] = false;
          answered[which] = true
       :: else /* for the agent before */
       fi
     }
  :: atomic {
       ((mine[0] > 0 && mine[1] > 0) || FAULTY(counts_who_is_back)) &&
       ((!asking[0] && !asking[1]) || FAULTY(tells_while_asking)) &&
       (mine[0] == 0 || taken < at[0]) && (mine[1] == 0 || taken < at[1]) && taken < granted ->
       taken++;
       up!DONE, me, 0, taken
     }
  :: atomic {
       !ended && crashes > 0 ->
       crashes--;
       if
       :: true -> skip
       :: true -> do :: up?_, _, _, _ :: empty(up) -> break od /* its last words are lost */
       fi;
       agent_gone = true; /* as the master sees, some time or other */
       goto start
     }
  od;
over:
  skip
}

proctype node(byte n) {
  byte me, mine_is, next;
  bool have; /* the message of tick `next`; earlier ones are used or part of the look-back */
start:
  me = 0; have = false;
  do
  :: atomic { !agent_gone && !ended -> mine_is = agent_now; answered[n] = false; asks[n]!1 };
     if
     :: atomic {
          answered[n] && mine_is == agent_now && !agent_gone ->
          me = given_inc[n]; next = given_tick[n]; break
        }
     :: agent_gone || mine_is != agent_now
     :: ended -> goto over
     fi
  :: ended -> goto over
  od;
  next = (next > LOOK_BACK -> next - LOOK_BACK : 1);
  do
  :: ended -> break
  :: atomic { !ended && (agent_gone || mine_is != agent_now) -> goto start } /* it ends with its agent */
  :: atomic {
       !ended && !have && next <= TICKS && highest >= next ->
       assert(lowest <= next);
       have = true
     }
  :: atomic {
       !ended && have && !agent_gone && mine_is == agent_now && (next <= granted || next < given_tick[n]) ->
       if
       :: next >= given_tick[n] ->
          assert(next > settled);
          WORKED(n, next) = true;
          heard[n]!me, next
       :: else
       fi;
       have = false;
       next++
     }
  :: atomic {
       !ended && crashes > 0 && !agent_gone && mine_is == agent_now ->
       crashes--;
       dead[n] = true;
       if
       :: true -> skip
       :: true -> do :: heard[n]?_, _ :: empty(heard[n]) -> break od
       fi;
       goto start
     }
  od;
over:
  skip
}

init {
  atomic { run node(0); run node(1) }
}

ltl run_ends { <> ended }
